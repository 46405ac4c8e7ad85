// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/port/name_lookup.h"

#include <boost/asio/ip/address.hpp>
#include <boost/system/error_code.hpp>
#include <system_error>
#include <thread>
#include <utility>

namespace inverter_bus
{
namespace wire
{
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
  if (!pending_.valid() && !start(error))
  {
    return {};
  }
  if (pending_.wait_until(deadline) != std::future_status::ready)
  {
    error = "no answer yet to the look-up of its name";
    return {};
  }
  Found found = pending_.get();
  error = found.error;
  return std::move(found.addresses);
}

bool NameLookup::goesOn() const
{
  return pending_.valid();
}

bool NameLookup::start(std::string& error)
{
  try
  {
    std::promise<Found> promise;
    pending_ = promise.get_future();
    std::thread([promise = std::move(promise), host = host_, resolver = resolver_]() mutable {
      Found found;
      found.addresses = resolver(host, found.error);
      promise.set_value(std::move(found));
    }).detach();
    return true;
  }
  catch (const std::system_error& refused)
  {
    pending_ = {};
    error = refused.what();
    return false;
  }
}
}  // namespace wire
}  // namespace inverter_bus
