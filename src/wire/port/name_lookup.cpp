// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/port/name_lookup.h"

#include <boost/asio/ip/address.hpp>
#include <boost/system/error_code.hpp>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "util/steady_condition.h"

namespace inverter_bus
{
namespace wire
{
struct NameLookup::Lookup
{
  std::mutex mutex;
  util::SteadyCondition ended;
  bool over = false;
  std::vector<std::string> addresses;
  std::string error;
};

NameLookup::NameLookup(std::string host, NameResolver resolver) : host_(std::move(host)), resolver_(std::move(resolver))
{
}

std::vector<std::string> NameLookup::find(TimePoint deadline, std::string& error)
{
  boost::system::error_code is_name;
  boost::asio::ip::make_address(host_, is_name);
  if (!is_name)
  {
    return { host_ };
  }
  if (!pending_ && !start(error))
  {
    return {};
  }
  const std::shared_ptr<Lookup> lookup = pending_;
  std::unique_lock<std::mutex> lock(lookup->mutex);
  if (!lookup->ended.waitUntil(lock, deadline, [&lookup] { return lookup->over; }))
  {
    error = "its name has not been resolved yet";
    return {};
  }
  pending_ = nullptr;
  error = lookup->error;
  return std::move(lookup->addresses);
}

bool NameLookup::goesOn() const
{
  return pending_ != nullptr;
}

bool NameLookup::start(std::string& error)
{
  try
  {
    pending_ = std::make_shared<Lookup>();
    std::thread([lookup = pending_, host = host_, resolver = resolver_] {
      std::string problem;
      std::vector<std::string> addresses = resolver(host, problem);
      const std::lock_guard<std::mutex> guard(lookup->mutex);
      lookup->addresses = std::move(addresses);
      lookup->error = std::move(problem);
      lookup->over = true;
      lookup->ended.notifyOne();
    }).detach();
    return true;
  }
  catch (const std::system_error& refused)
  {
    pending_ = nullptr;
    error = refused.what();
    return false;
  }
}
}  // namespace wire
}  // namespace inverter_bus
