// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BENCHMARK_SCENE_H
#define INVERTER_BUS_BENCHMARK_SCENE_H

#include <algorithm>
#include <sstream>
#include <string>

namespace inverter_bus
{
namespace benchmark
{
/// Which drives stand on a bus. The figures of all programs are of the same scenes.
struct Scene
{
  unsigned inverters = 5;
  unsigned baud = 19200;
  std::string drive = "omron_mx2";  ///< or toshiba_vfs15, with its block selected
  double reply_delay = 0.005;  ///< [s] from the end of a request to its reply, the silence of 3.5 characters included
  bool mapped = false;         ///< MX2: its register map is set, and its owner allows its use
};

/// Silence that Modbus RTU asks for before a frame, 8N1 [s].
inline double silence(unsigned baud)
{
  return baud > 19200 ? 0.00175 : 35.0 / baud;
}

/// One scan list for the driver and for the simulated drives.
inline std::string scanList(const Scene& scene, const std::string& port)
{
  std::ostringstream yaml;
  yaml << "port: " << port << "\nbaud_rate: " << scene.baud << "\ndefaults: {drive: " << scene.drive
       << ", command_timeout: 0" << (scene.mapped ? ", configure_map: true, confirm: [register_map]" : "") << "}\n"
       << "scan_list:\n";
  for (unsigned node = 1; node <= scene.inverters; ++node)
  {
    yaml << "  - {name: belt_" << node << ", node: " << node << "}\n";
  }
  yaml << "simulation:\n";
  const double turnaround = std::max(0.0, scene.reply_delay - silence(scene.baud));
  for (unsigned node = 1; node <= scene.inverters; ++node)
  {
    yaml << "  belt_" << node << ": {turnaround: " << turnaround;
    if (scene.drive == "toshiba_vfs15")
    {
      yaml << ", parameters: {F870: 1, F871: 3, F875: 1, F876: 2, F877: 3, F878: 4, F879: 14}";
    }
    yaml << (scene.mapped ? ", parameters: {P200: 1, P201: 4101, P202: 4102, P301: 7681, P302: 7937}" : "") << "}\n";
  }
  return yaml.str();
}
}  // namespace benchmark
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BENCHMARK_SCENE_H
