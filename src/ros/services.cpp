// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/services.h"

#include <chrono>
#include <limits>
#include <memory>
#include <utility>

#include <ros/advertise_service_options.h>
#include <boost/function.hpp>

#include "inverter_bus/wire/request.h"
#include "ros/status_conversion.h"
#include "util/steady_event.h"
#include "util/text.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
/// Stops that may wait for their answers. One beyond is carried out just the same, and answered at once.
constexpr std::size_t MOST_WAITING_STOPS = 500;
/// The rest is for those that don't wait.
constexpr std::size_t STOP_THREADS = MOST_WAITING_STOPS + 12;
constexpr std::size_t OTHER_THREADS = 128;

/// The bus answers within its bound; this is for the answer's way through the threads of a busy machine.
constexpr double MARGIN = 0.5;

/// Where a service thread and the bus thread meet. Shared: the answer may come when the call no longer waits.
struct AnswerSlot
{
  bus::Answer answer;
  util::SteadyEvent answered;
};

bus::Answer timeoutAnswer(const std::string& message)
{
  bus::Answer answer;
  answer.error_id = wire::ERROR_TIMEOUT;
  answer.message = message;
  return answer;
}

/// Starts something on the bus and waits for its answer.
bus::Answer ask(double bound, const std::function<void(bus::AnswerCallback)>& start)
{
  const auto slot = std::make_shared<AnswerSlot>();
  start([slot](const bus::Answer& answer) {
    slot->answer = answer;
    slot->answered.set();
  });
  if (slot->answered.waitFor(seconds(bound + MARGIN)))
  {
    return slot->answer;
  }
  return timeoutAnswer("the bus gave no answer in " + util::numberText(bound + MARGIN) + " s: see /diagnostics");
}

template <typename Response>
void fill(const bus::Answer& answer, Response& response)
{
  response.success = answer.success;
  response.error_id = answer.error_id;
  response.message = answer.message;
}
}  // namespace

Services::Services(ros::NodeHandle node, const bus::BusConfig& config, bus::Bus& bus, TraceFiles& traces)
  : bus_(bus), traces_(traces), bounds_(bus.bounds()), stop_queue_(STOP_THREADS), queue_(OTHER_THREADS)
{
  advertise<Stop>(node, "stop", stop_queue_, [this](const Stop::Request& request, Stop::Response& response) {
    answerStop(std::nullopt, request, response);
  });
  for (std::size_t i = 0; i < config.inverters.size(); ++i)
  {
    advertiseFor(node, i, config.inverters[i].name + "/");
  }
  advertise<std_srvs::Trigger>(
      node, "dump_trace", queue_,
      [this](const std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) { answerDumpTrace(response); });
}

Services::~Services()
{
  stop();
}

void Services::drain(Duration timeout)
{
  stop_queue_.waitIdle(timeout);
  queue_.waitIdle(timeout);
}

void Services::stop()
{
  for (ros::ServiceServer& server : servers_)
  {
    server.shutdown();
  }
  stop_queue_.shutdown();
  queue_.shutdown();
}

void Services::advertiseFor(ros::NodeHandle& node, std::size_t index, const std::string& name)
{
  advertise<Stop>(
      node, name + "stop", stop_queue_,
      [this, index](const Stop::Request& request, Stop::Response& response) { answerStop(index, request, response); });
  advertise<Reset>(node, name + "reset", queue_,
                   [this, index](const Reset::Request&, Reset::Response& response) { answerReset(index, response); });
  advertise<ReadFaults>(
      node, name + "read_faults", queue_,
      [this, index](const ReadFaults::Request&, ReadFaults::Response& response) { answerReadFaults(index, response); });
  advertise<ReadParameter>(node, name + "read_parameter", queue_,
                           [this, index](const ReadParameter::Request& request, ReadParameter::Response& response) {
                             answerReadParameter(index, request, response);
                           });
  advertise<WriteParameter>(node, name + "write_parameter", queue_,
                            [this, index](const WriteParameter::Request& request, WriteParameter::Response& response) {
                              answerWriteParameter(index, request, response);
                            });
}

template <typename Service>
void Services::advertise(ros::NodeHandle& node, const std::string& name, ElasticQueue& queue,
                         std::function<void(const typename Service::Request&, typename Service::Response&)> handler)
{
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback = [handler](Request& request, Response& response) {
    handler(request, response);
    return true;
  };
  auto options = ros::AdvertiseServiceOptions::create<Service>(name, callback, ros::VoidConstPtr(), &queue);
  servers_.push_back(node.advertiseService(options));
}

void Services::answerStop(std::optional<std::size_t> index, const Stop::Request& request, Stop::Response& response)
{
  if (++waiting_stops_ <= MOST_WAITING_STOPS)
  {
    fill(ask(bounds_.stop, [&](bus::AnswerCallback callback) { bus_.stop(index, request.mode, std::move(callback)); }),
         response);
  }
  else
  {
    bus_.stop(index, request.mode, bus::AnswerCallback());
    fill(timeoutAnswer("the stop is under way, but too many calls wait for its confirmation: see the status"),
         response);
  }
  --waiting_stops_;
}

void Services::answerReset(std::size_t index, Reset::Response& response)
{
  fill(ask(bounds_.reset, [&](bus::AnswerCallback callback) { bus_.reset(index, std::move(callback)); }), response);
}

void Services::answerReadFaults(std::size_t index, ReadFaults::Response& response)
{
  const bus::Answer answer =
      ask(bounds_.read_faults, [&](bus::AnswerCallback callback) { bus_.readFaults(index, std::move(callback)); });
  fill(answer, response);
  response.present = toMessage(answer.present);
  for (const drive::FaultRecord& record : answer.faults)
  {
    response.faults.push_back(toMessage(record));
  }
}

void Services::answerReadParameter(std::size_t index, const ReadParameter::Request& request,
                                   ReadParameter::Response& response)
{
  const bus::Answer answer = ask(bounds_.read_parameter, [&](bus::AnswerCallback callback) {
    bus_.readParameter(index, request.name, std::move(callback));
  });
  fill(answer, response);
  response.value = answer.success ? answer.value : std::numeric_limits<double>::quiet_NaN();
  response.unit = answer.unit;
}

void Services::answerWriteParameter(std::size_t index, const WriteParameter::Request& request,
                                    WriteParameter::Response& response)
{
  fill(ask(bounds_.write_parameter,
           [&](bus::AnswerCallback callback) {
             bus_.writeParameter(index, request.name, request.value, request.persist != 0, std::move(callback));
           }),
       response);
}

void Services::answerDumpTrace(std_srvs::Trigger::Response& response)
{
  std::string error;
  const std::string path =
      traces_.writeAsked([this] { return bus_.dumpTrace(); }, std::chrono::steady_clock::now(), error);
  response.success = !path.empty();
  response.message = path.empty() ? error : path;
}
}  // namespace ros_node
}  // namespace inverter_bus
