// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/toshiba/toshiba_parameters.h"

#include <algorithm>

#include "simulation/drives/toshiba/toshiba_numbers.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr bool RUN = true;             // may be written while the motor runs
constexpr bool STOP = false;           // only at rest; the sources name FH and no other, the rest of these is M
constexpr std::uint32_t W = 0xFFFF;    // range unknown: whatever the register holds
constexpr std::uint32_t HZ = 50000;    // 500.00 Hz: where the upper end is FH, UL ... see ToshibaVfs15::rangeOf()
constexpr std::uint32_t LOW = 6000;    // base frequency of a drive for 60 Hz
constexpr std::uint32_t TIME = 36000;  // 3600.0 s, or 360.00 s with F519 = 1

// Range and resolution: S = seen in a source (E6581913, option manuals, field code), M = from memory.
const std::vector<Parameter> TABLE = {
  // Basics: titles without F
  { "AU1", 0x0000, 1, 0, 0, 2, 0, STOP, 0 },        // S
  { "AU2", 0x0001, 1, 0, 0, 3, 0, STOP, 0 },        // M
  { "CMOD", 0x0003, 1, 0, 0, 4, 1, RUN, 0 },        // S; F736
  { "FMOD", 0x0004, 1, 0, 0, 14, 0, RUN, 0x49FF },  // S; F736
  { "FMSL", 0x0005, 1, 0, 0, 23, 0, RUN, 0 },       // M
  { "FM", 0x0006, 1, 0, 0, W, 0, RUN, 0 },          // M
  { "tYP", 0x0007, 1, 0, 0, 14, 0, STOP, 0 },       // M
  { "Fr", 0x0008, 1, 0, 0, 3, 0, RUN, 0 },          // M
  { "ACC", 0x0009, 1, 1, 0, TIME, 100, RUN, 0 },    // S
  { "dEC", 0x0010, 1, 1, 0, TIME, 100, RUN, 0 },    // S
  { "FH", 0x0011, 1, 2, 3000, HZ, 8000, STOP, 0 },  // unit and lock S, range M
  { "UL", 0x0012, 1, 2, 50, HZ, LOW, RUN, 0 },      // unit S, range M
  { "LL", 0x0013, 1, 2, 0, HZ, 0, RUN, 0 },         // M
  { "vL", 0x0014, 1, 2, 2000, HZ, LOW, RUN, 0 },    // unit S, range M
  { "Pt", 0x0015, 1, 0, 0, 8, 0, STOP, 0 },         // M
  { "vb", 0x0016, 1, 1, 0, 300, 60, RUN, 0 },       // M
  { "OLM", 0x0017, 1, 0, 0, 7, 0, RUN, 0 },         // M
  { "Sr1", 0x0018, 1, 2, 0, HZ, 0, RUN, 0 },        // M
  { "Sr2", 0x0019, 1, 2, 0, HZ, 0, RUN, 0 },
  { "Sr3", 0x0020, 1, 2, 0, HZ, 0, RUN, 0 },
  { "Sr4", 0x0021, 1, 2, 0, HZ, 0, RUN, 0 },
  { "Sr5", 0x0022, 1, 2, 0, HZ, 0, RUN, 0 },
  { "Sr6", 0x0023, 1, 2, 0, HZ, 0, RUN, 0 },
  { "Sr7", 0x0024, 1, 2, 0, HZ, 0, RUN, 0 },
  { "FPId", 0x0025, 1, 2, 0, HZ, 0, RUN, 0 },        // M
  { "AUL", 0x0094, 1, 0, 0, 2, 0, STOP, 0 },         // S
  { "SEt", 0x0099, 1, 0, 0, W, 0, RUN, 0 },          // M
  { "0999", 0x0999, 1, 0, 1, 2, 2, RUN, 0 },         // S: unit of the ramp times, read only
  { "vLv", 0x0409, 1, 1, 500, 6600, 2000, RUN, 0 },  // M
  { "tHr", 0x0600, 1, 0, 10, 100, 100, RUN, 0 },     // M
  // F1: terminals
  { "F100", 0x0100, 1, 2, 0, HZ, 0, RUN, 0 },       // M
  { "F101", 0x0101, 1, 2, 0, HZ, 0, RUN, 0 },       // M
  { "F102", 0x0102, 1, 2, 0, HZ, 250, RUN, 0 },     // M
  { "F104", 0x0104, 1, 0, 0, 203, 0, STOP, 0 },     // M
  { "F108", 0x0108, 1, 0, 0, 203, 0, STOP, 0 },     // M
  { "F109", 0x0109, 1, 0, 0, 4, 0, STOP, 0 },       // S
  { "F110", 0x0110, 1, 0, 0, 203, 6, STOP, 0 },     // M
  { "F111", 0x0111, 1, 0, 0, 203, 2, STOP, 0 },     // M
  { "F112", 0x0112, 1, 0, 0, 203, 4, STOP, 0 },     // M
  { "F113", 0x0113, 1, 0, 0, 203, 8, STOP, 0 },     // M
  { "F114", 0x0114, 1, 0, 0, 203, 10, STOP, 0 },    // M
  { "F115", 0x0115, 1, 0, 0, 203, 12, STOP, 0 },    // M
  { "F116", 0x0116, 1, 0, 0, 203, 14, STOP, 0 },    // M
  { "F117", 0x0117, 1, 0, 0, 203, 16, STOP, 0 },    // M
  { "F118", 0x0118, 1, 0, 0, 203, 24, STOP, 0 },    // M
  { "F130", 0x0130, 1, 0, 0, 255, 4, STOP, 0 },     // default S
  { "F131", 0x0131, 1, 0, 0, 255, 6, STOP, 0 },     // default S
  { "F132", 0x0132, 1, 0, 0, 255, 10, STOP, 0 },    // default S
  { "F147", 0x0147, 1, 0, 0, 1, 0, STOP, 0 },       // S
  { "F170", 0x0170, 1, 2, 2000, HZ, LOW, RUN, 0 },  // unit S
  { "F171", 0x0171, 1, 1, 500, 6600, 2000, RUN, 0 },
  { "F172", 0x0172, 1, 1, 0, 300, 60, RUN, 0 },
  { "F173", 0x0173, 1, 0, 10, 100, 100, RUN, 0 },
  { "F185", 0x0185, 1, 0, 10, 200, 150, RUN, 0 },  // S
  // F2: sources, braking, jog, preset speeds
  { "F207", 0x0207, 1, 0, 0, 14, 1, RUN, 0x49FF },  // S
  { "F240", 0x0240, 1, 2, 10, 1000, 50, RUN, 0 },   // M
  { "F241", 0x0241, 1, 2, 0, HZ, 0, RUN, 0 },       // M
  { "F242", 0x0242, 1, 2, 0, HZ, 0, RUN, 0 },       // M
  { "F250", 0x0250, 1, 2, 0, HZ, 0, RUN, 0 },       // M
  { "F251", 0x0251, 1, 0, 0, 100, 50, RUN, 0 },     // S
  { "F252", 0x0252, 1, 1, 0, 255, 10, RUN, 0 },     // M
  { "F256", 0x0256, 1, 1, 0, 6000, 0, RUN, 0 },     // M
  { "F260", 0x0260, 1, 2, 10, 2000, 500, RUN, 0 },  // M
  { "F261", 0x0261, 1, 0, 0, 2, 0, RUN, 0 },        // M
  { "F262", 0x0262, 1, 0, 0, 1, 0, RUN, 0 },        // M
  { "F268", 0x0268, 1, 2, 0, HZ, 0, RUN, 0 },       // M
  { "F287", 0x0287, 1, 2, 0, HZ, 0, RUN, 0 },       // M
  { "F288", 0x0288, 1, 2, 0, HZ, 0, RUN, 0 },
  { "F289", 0x0289, 1, 2, 0, HZ, 0, RUN, 0 },
  { "F290", 0x0290, 1, 2, 0, HZ, 0, RUN, 0 },
  { "F291", 0x0291, 1, 2, 0, HZ, 0, RUN, 0 },
  { "F292", 0x0292, 1, 2, 0, HZ, 0, RUN, 0 },
  { "F293", 0x0293, 1, 2, 0, HZ, 0, RUN, 0 },
  { "F294", 0x0294, 1, 2, 0, HZ, 0, RUN, 0 },
  // F3: carrier, restart, protection of the supply
  { "F300", 0x0300, 1, 1, 20, 160, 120, RUN, 0 },  // M
  { "F301", 0x0301, 1, 0, 0, 4, 0, RUN, 0 },       // M
  { "F302", 0x0302, 1, 0, 0, 3, 0, RUN, 0 },       // M
  { "F303", 0x0303, 1, 0, 0, 10, 0, RUN, 0 },      // M
  { "F304", 0x0304, 1, 0, 0, 4, 0, RUN, 0 },       // M
  { "F305", 0x0305, 1, 0, 0, 3, 2, RUN, 0 },       // M
  { "F307", 0x0307, 1, 0, 0, 3, 2, RUN, 0 },       // M
  { "F311", 0x0311, 1, 0, 0, 2, 0, RUN, 0 },       // M
  // F4: motor
  { "F400", 0x0400, 1, 0, 0, 5, 0, STOP, 0 },           // M
  { "F402", 0x0402, 1, 1, 0, 300, 60, RUN, 0 },         // M
  { "F405", 0x0405, 1, 2, 1, 2200, 75, STOP, 0 },       // S
  { "F415", 0x0415, 1, 2, 10, 10000, 330, STOP, 0 },    // S
  { "F416", 0x0416, 1, 0, 10, 90, 55, STOP, 0 },        // M
  { "F417", 0x0417, 1, 0, 100, 64000, 1710, STOP, 0 },  // M
  { "F458", 0x0458, 1, 0, 0, W, 0, STOP, 0 },
  { "F459", 0x0459, 1, 1, 0, W, 10, STOP, 0 },
  { "F460", 0x0460, 1, 1, 0, W, 10, STOP, 0 },
  { "F495", 0x0495, 1, 0, 0, W, 104, STOP, 0 },
  // F5: ramps 2 and 3
  { "F500", 0x0500, 1, 1, 0, TIME, 100, RUN, 0 },  // S
  { "F501", 0x0501, 1, 1, 0, TIME, 100, RUN, 0 },  // S
  { "F505", 0x0505, 1, 2, 0, HZ, 0, RUN, 0 },      // S
  { "F510", 0x0510, 1, 1, 0, TIME, 100, RUN, 0 },  // S
  { "F511", 0x0511, 1, 1, 0, TIME, 100, RUN, 0 },  // S
  { "F519", 0x0519, 1, 0, 0, 2, 0, STOP, 0 },      // S
  // F6: protection
  { "F601", 0x0601, 1, 0, 10, 200, 150, RUN, 0 },   // S
  { "F602", 0x0602, 1, 0, 0, 1, 0, RUN, 0 },        // M
  { "F603", 0x0603, 1, 0, 0, 5, 0, RUN, 0 },        // M
  { "F605", 0x0605, 1, 0, 0, 5, 0, RUN, 0 },        // M
  { "F608", 0x0608, 1, 0, 0, 1, 1, RUN, 0 },        // M
  { "F615", 0x0615, 1, 0, 0, 1, 0, RUN, 0 },        // M
  { "F616", 0x0616, 1, 0, 0, 250, 150, RUN, 0 },    // M
  { "F618", 0x0618, 1, 1, 0, 100, 5, RUN, 0 },      // M
  { "F619", 0x0619, 1, 0, 0, 100, 10, RUN, 0 },     // M
  { "F621", 0x0621, 1, 1, 0, 9999, 8760, RUN, 0 },  // M
  { "F627", 0x0627, 1, 0, 0, 2, 0, RUN, 0 },        // M
  { "F648", 0x0648, 1, 1, 0, 9990, 9990, RUN, 0 },  // M
  // F7: panel and protection of the parameters
  { "F700", 0x0700, 1, 0, 0, 4, 0, RUN, 0 },  // S
  { "F701", 0x0701, 1, 0, 0, 1, 0, RUN, 0 },  // M
  { "F719", 0x0719, 1, 0, 0, 3, 1, RUN, 0 },  // S
  { "F736", 0x0736, 1, 0, 0, 1, 1, RUN, 0 },  // M
  { "F749", 0x0749, 1, 0, 0, 4, 1, RUN, 0 },  // range S
  // F8: communication, all S
  { "F800", 0x0800, 1, 0, 3, 5, 4, RUN, 0 },
  { "F801", 0x0801, 1, 0, 0, 2, 1, RUN, 0 },
  { "F802", 0x0802, 1, 0, 0, 247, 0, RUN, 0 },
  { "F803", 0x0803, 1, 1, 0, 1000, 0, RUN, 0 },
  { "F804", 0x0804, 1, 0, 0, 2, 0, RUN, 0 },
  { "F805", 0x0805, 1, 2, 0, 200, 0, RUN, 0 },
  { "F806", 0x0806, 1, 0, 0, 4, 0, RUN, 0 },
  { "F808", 0x0808, 1, 0, 0, 2, 1, RUN, 0 },
  { "F810", 0x0810, 1, 0, 0, W, 0, RUN, 0 },
  { "F811", 0x0811, 1, 0, 0, 100, 0, RUN, 0 },
  { "F812", 0x0812, 1, 2, 0, HZ, 0, RUN, 0 },
  { "F813", 0x0813, 1, 0, 0, 100, 100, RUN, 0 },
  { "F814", 0x0814, 1, 2, 0, HZ, 6000, RUN, 0 },
  { "F829", 0x0829, 1, 0, 0, 1, 0, RUN, 0 },
  { "F856", 0x0856, 1, 0, 1, 8, 2, RUN, 0 },
  { "F870", 0x0870, 1, 0, 0, 6, 0, RUN, 0 },
  { "F871", 0x0871, 1, 0, 0, 6, 0, RUN, 0 },
  { "F875", 0x0875, 1, 0, 0, 14, 0, RUN, 0 },
  { "F876", 0x0876, 1, 0, 0, 14, 0, RUN, 0 },
  { "F877", 0x0877, 1, 0, 0, 14, 0, RUN, 0 },
  { "F878", 0x0878, 1, 0, 0, 14, 0, RUN, 0 },
  { "F879", 0x0879, 1, 0, 0, 14, 0, RUN, 0 },
  { "F880", 0x0880, 1, 0, 0, W, 0, RUN, 0 },
  { "F899", 0x0899, 1, 0, 0, 1, 0, RUN, 0 },
  // F9: permanent-magnet motor
  { "F910", 0x0910, 1, 2, 0, W, 10000, STOP, 0 },
  { "F911", 0x0911, 1, 2, 0, W, 0, STOP, 0 },
  { "F912", 0x0912, 1, 2, 0, W, 1000, STOP, 0 },
  { "F913", 0x0913, 1, 2, 0, W, 1000, STOP, 0 },
  { "F915", 0x0915, 1, 0, 0, 4, 3, STOP, 0 },
  { "F916", 0x0916, 1, 0, 0, W, 25, STOP, 0 },
  // Beside the F parameters, in the EEPROM too
  { "FA03", 0xFA03, 1, 2, 0, HZ, 0, RUN, 0 },  // S: panel frequency
  { "FA08", 0xFA08, 1, 0, 0, 1, 0, RUN, 0 },   // S: 1 = local
  // Name plate, read only: a VFS15-2007PM
  { "FE70", 0xFE70, 1, 1, 1, 9999, 48, RUN, 0 },
  { "FE71", 0xFE71, 1, 1, 10, 9999, 2000, RUN, 0 },
};
}  // namespace

std::vector<Parameter> vfs15Parameters()
{
  return TABLE;
}

std::vector<Parameter> vfs11Parameters()
{
  std::vector<Parameter> table = TABLE;
  const auto slot = [](const Parameter& one) { return one.number >= toshiba::F870 && one.number <= toshiba::F879; };
  table.erase(std::remove_if(table.begin(), table.end(), slot), table.end());
  for (Parameter& parameter : table)
  {
    parameter.initial = parameter.number == toshiba::F800 ? 3 : parameter.initial;  // 9600 baud
  }
  return table;
}
}  // namespace simulation
}  // namespace inverter_bus
