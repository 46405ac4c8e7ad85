// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/hitachi/hitachi_parameters.h"

#include <algorithm>
#include <cstdio>
#include <string>

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr bool RUN = true;    // may be written while the motor runs (MEM: the manuals' column "change in run mode")
constexpr bool STOP = false;  // only at rest
constexpr std::uint32_t W1 = 0xFFFF;      // range unknown: whatever the register holds
constexpr std::uint32_t W2 = 0xFFFFFFFF;  // the same for two registers

// Range and resolution: S = seen in a source, M = from memory. Numbers are the printed ones.
const std::vector<Parameter> COMMON = {
  // F: ramps. Unit S, range M
  { "F002", 0x1103, 2, 2, 1, 360000, 1000, RUN, 0 },
  { "F003", 0x1105, 2, 2, 1, 360000, 1000, RUN, 0 },
  { "F004", 0x1107, 1, 0, 0, 1, 0, STOP, 0 },
  { "F202", 0x2103, 2, 2, 1, 360000, 1000, RUN, 0 },
  { "F203", 0x2105, 2, 2, 1, 360000, 1000, RUN, 0 },
  // A: basics
  { "A005", 0x1205, 1, 0, 0, 4, 0, STOP, 0 },         // M
  { "A011", 0x120B, 2, 2, 0, 40000, 0, STOP, 0 },     // S
  { "A012", 0x120D, 2, 2, 0, 40000, 0, STOP, 0 },     // S
  { "A013", 0x120F, 1, 0, 0, 100, 0, STOP, 0 },       // S
  { "A014", 0x1210, 1, 0, 0, 100, 100, STOP, 0 },     // S
  { "A015", 0x1211, 1, 0, 0, 1, 1, STOP, 0 },         // S
  { "A016", 0x1212, 1, 0, 1, 31, 8, STOP, 0 },        // S
  { "A017", 0x1213, 1, 0, 0, 2, 0, STOP, 0 },         // S/M
  { "A019", 0x1215, 1, 0, 0, 1, 0, STOP, 0 },         // S
  { "A020", 0x1216, 2, 2, 0, 40000, 0, RUN, 0 },      // S
  { "A038", 0x1238, 1, 2, 0, 999, 600, RUN, 0 },      // M
  { "A039", 0x1239, 1, 0, 0, 5, 4, STOP, 0 },         // M
  { "A041", 0x123B, 1, 0, 0, 1, 0, STOP, 0 },         // M
  { "A042", 0x123C, 1, 1, 0, 200, 10, RUN, 0 },       // M
  { "A043", 0x123D, 1, 1, 0, 500, 50, RUN, 0 },       // M
  { "A044", 0x123E, 1, 0, 0, 5, 0, STOP, 0 },         // M
  { "A045", 0x123F, 1, 0, 20, 100, 100, RUN, 0 },     // M
  { "A051", 0x1245, 1, 0, 0, 2, 0, STOP, 0 },         // M
  { "A052", 0x1246, 1, 2, 0, 6000, 50, STOP, 0 },     // M
  { "A053", 0x1247, 1, 1, 0, 50, 0, STOP, 0 },        // M
  { "A054", 0x1248, 1, 0, 0, 100, 50, STOP, 0 },      // M
  { "A055", 0x1249, 1, 1, 0, 600, 5, STOP, 0 },       // M
  { "A057", 0x124B, 1, 0, 0, 100, 0, STOP, 0 },       // M
  { "A058", 0x124C, 1, 1, 0, 600, 0, STOP, 0 },       // M
  { "A061", 0x124F, 2, 2, 0, 40000, 0, STOP, 0 },     // S
  { "A062", 0x1251, 2, 2, 0, 40000, 0, STOP, 0 },     // S
  { "A063", 0x1253, 2, 2, 0, 40000, 0, STOP, 0 },     // S
  { "A064", 0x1255, 1, 2, 0, 1000, 50, STOP, 0 },     // S
  { "A065", 0x1256, 2, 2, 0, 40000, 0, STOP, 0 },     // S
  { "A066", 0x1258, 1, 2, 0, 1000, 50, STOP, 0 },     // S
  { "A067", 0x1259, 2, 2, 0, 40000, 0, STOP, 0 },     // S
  { "A068", 0x125B, 1, 2, 0, 1000, 50, STOP, 0 },     // S
  { "A069", 0x125C, 2, 2, 0, 40000, 0, STOP, 0 },     // S
  { "A070", 0x125E, 1, 1, 0, 600, 0, STOP, 0 },       // S
  { "A071", 0x125F, 1, 0, 0, 2, 0, STOP, 0 },         // S
  { "A073", 0x1261, 1, 1, 0, 36000, 10, RUN, 0 },     // M
  { "A074", 0x1262, 1, 2, 0, 10000, 0, RUN, 0 },      // M
  { "A075", 0x1263, 1, 2, 1, 9999, 100, STOP, 0 },    // M
  { "A076", 0x1264, 1, 0, 0, 10, 0, STOP, 0 },        // M
  { "A081", 0x1269, 1, 0, 0, 2, 2, STOP, 0 },         // M
  { "A082", 0x126A, 1, 0, 0, 10, 0, STOP, 0 },        // M
  { "A085", 0x126D, 1, 0, 0, 2, 0, STOP, 0 },         // M
  { "A092", 0x1274, 2, 2, 1, 360000, 1000, RUN, 0 },  // M
  { "A093", 0x1276, 2, 2, 1, 360000, 1000, RUN, 0 },  // M
  { "A094", 0x1278, 1, 0, 0, 2, 0, STOP, 0 },         // M
  { "A095", 0x1279, 2, 2, 0, 40000, 0, STOP, 0 },     // M
  { "A096", 0x127B, 2, 2, 0, 40000, 0, STOP, 0 },     // M
  { "A097", 0x127D, 1, 0, 0, 4, 1, STOP, 0 },         // M
  { "A098", 0x127E, 1, 0, 0, 4, 1, STOP, 0 },         // M
  { "A141", 0x12AF, 1, 0, 0, 7, 2, STOP, 0 },         // M
  { "A142", 0x12B0, 1, 0, 0, 7, 3, STOP, 0 },         // M
  { "A143", 0x12B1, 1, 0, 0, 2, 0, STOP, 0 },         // M
  { "A145", 0x12B3, 2, 2, 0, 40000, 0, RUN, 0 },      // S
  { "A146", 0x12B5, 1, 0, 0, 1, 0, STOP, 0 },         // S
  { "A201", 0x2201, 1, 0, 0, 10, 2, STOP, 0 },        // M, "same offset as A001"
  { "A202", 0x2202, 1, 0, 1, 5, 2, STOP, 0 },         // M
  { "A220", 0x2216, 2, 2, 0, 40000, 0, RUN, 0 },      // M
  // b: protection and adjustment
  { "b001", 0x1301, 1, 0, 0, 4, 0, STOP, 0 },          // S
  { "b002", 0x1302, 1, 1, 3, 250, 10, STOP, 0 },       // S
  { "b003", 0x1303, 1, 1, 3, 1000, 10, STOP, 0 },      // S
  { "b004", 0x1304, 1, 0, 0, 2, 0, STOP, 0 },          // S
  { "b005", 0x1305, 1, 0, 0, 1, 0, STOP, 0 },          // S
  { "b007", 0x1307, 2, 2, 0, 40000, 0, STOP, 0 },      // S
  { "b008", 0x1309, 1, 0, 0, 4, 0, STOP, 0 },          // S
  { "b010", 0x130B, 1, 0, 1, 3, 3, STOP, 0 },          // S
  { "b011", 0x130C, 1, 1, 3, 1000, 10, STOP, 0 },      // S
  { "b012", 0x130D, 1, 1, 200, 1000, 1000, STOP, 0 },  // S: 0.1 % of the rated current
  { "b013", 0x130E, 1, 0, 0, 2, 1, STOP, 0 },          // S
  { "b212", 0x230C, 1, 1, 200, 1000, 1000, STOP, 0 },  // M
  { "b021", 0x1316, 1, 0, 0, 3, 1, STOP, 0 },          // M
  { "b022", 0x1317, 1, 1, 200, 2000, 1500, RUN, 0 },   // M
  { "b023", 0x1318, 1, 1, 1, 30000, 10, STOP, 0 },     // M
  { "b024", 0x1319, 1, 0, 0, 3, 1, STOP, 0 },          // M
  { "b025", 0x131A, 1, 1, 200, 2000, 1500, RUN, 0 },   // M
  { "b026", 0x131B, 1, 1, 1, 30000, 10, STOP, 0 },     // M
  { "b027", 0x131C, 1, 0, 0, 1, 0, STOP, 0 },          // M
  { "b031", 0x1320, 1, 0, 0, 10, 1, RUN, 0x40F },      // M: 0, 1, 2, 3, 10
  { "b035", 0x1325, 1, 0, 0, 2, 0, STOP, 0 },          // M
  { "b037", 0x1327, 1, 0, 0, 5, 4, STOP, 0 },          // M
  { "b040", 0x132A, 1, 0, 0, 4, 0, STOP, 0 },          // M
  { "b041", 0x132B, 1, 0, 0, 255, 200, RUN, 0 },       // M
  { "b042", 0x132C, 1, 0, 0, 255, 200, RUN, 0 },       // M
  { "b043", 0x132D, 1, 0, 0, 255, 200, RUN, 0 },       // M
  { "b044", 0x132E, 1, 0, 0, 255, 200, RUN, 0 },       // M
  { "b053", 0x1337, 2, 2, 1, 360000, 100, STOP, 0 },   // M
  { "b082", 0x1355, 1, 2, 10, 999, 50, STOP, 0 },      // M
  { "b084", 0x1357, 1, 0, 0, 4, 0, STOP, 0 },          // M
  { "b085", 0x1358, 1, 0, 0, 3, 0, STOP, 0 },          // M
  { "b086", 0x1359, 1, 2, 1, 9999, 100, RUN, 0 },      // M
  { "b087", 0x135A, 1, 0, 0, 2, 0, STOP, 0 },          // M: 0 = STOP key works, 1 = disabled
  { "b088", 0x135B, 1, 0, 0, 2, 0, STOP, 0 },          // M
  { "b090", 0x135D, 1, 1, 0, 1000, 0, STOP, 0 },       // M
  { "b091", 0x135E, 1, 0, 0, 1, 0, STOP, 0 },          // M: 0 = ramp, 1 = free run
  { "b095", 0x1362, 1, 0, 0, 2, 1, STOP, 0 },          // M
  { "b096", 0x1363, 1, 0, 330, 780, 360, STOP, 0 },    // M
  { "b130", 0x1385, 1, 0, 0, 2, 0, STOP, 0 },          // M
  { "b131", 0x1386, 1, 0, 330, 780, 380, STOP, 0 },    // M
  // C: terminals
  { "C001", 0x1401, 1, 0, 0, 255, 0, STOP, 0 },     // M: 0 = FW, 1 = RV, 11 = FRS
  { "C002", 0x1402, 1, 0, 0, 255, 1, STOP, 0 },     // M
  { "C003", 0x1403, 1, 0, 0, 255, 12, STOP, 0 },    // M
  { "C004", 0x1404, 1, 0, 0, 255, 18, STOP, 0 },    // M
  { "C005", 0x1405, 1, 0, 0, 255, 2, STOP, 0 },     // M
  { "C006", 0x1406, 1, 0, 0, 255, 3, STOP, 0 },     // M
  { "C007", 0x1407, 1, 0, 0, 255, 6, STOP, 0 },     // M
  { "C021", 0x1415, 1, 0, 0, 255, 1, STOP, 0 },     // M
  { "C022", 0x1416, 1, 0, 0, 255, 0, STOP, 0 },     // M
  { "C026", 0x141A, 1, 0, 0, 255, 5, STOP, 0 },     // M
  { "C027", 0x141B, 1, 0, 0, 255, 7, STOP, 0 },     // M
  { "C028", 0x141C, 1, 0, 0, 255, 7, STOP, 0 },     // M
  { "C031", 0x141F, 1, 0, 0, 1, 0, STOP, 0 },       // M
  { "C032", 0x1420, 1, 0, 0, 1, 0, STOP, 0 },       // M
  { "C036", 0x1424, 1, 0, 0, 1, 1, STOP, 0 },       // M
  { "C040", 0x1428, 1, 0, 0, 1, 1, STOP, 0 },       // M
  { "C041", 0x1429, 1, 1, 0, 2000, 1150, RUN, 0 },  // M: 0.1 % of the rated current
  { "C042", 0x142A, 2, 2, 0, 40000, 0, RUN, 0 },    // M
  { "C043", 0x142C, 2, 2, 0, 40000, 0, RUN, 0 },    // M
  { "C044", 0x142E, 1, 1, 0, 1000, 30, STOP, 0 },   // M
  { "C045", 0x142F, 2, 2, 0, 40000, 0, RUN, 0 },    // M
  { "C046", 0x1431, 2, 2, 0, 40000, 0, RUN, 0 },    // M
  { "C061", 0x1441, 1, 0, 0, 100, 90, STOP, 0 },    // M
  { "C063", 0x1443, 1, 2, 0, 10000, 0, STOP, 0 },   // M
  { "C064", 0x1444, 1, 0, 0, 110, 100, STOP, 0 },   // M
  // C: communication. Ranges S (SEED, I585, I578)
  { "C074", 0x144E, 1, 0, 0, 2, 0, STOP, 0 },
  { "C075", 0x144F, 1, 0, 1, 2, 1, STOP, 0 },
  { "C076", 0x1450, 1, 0, 0, 4, 2, STOP, 0 },
  { "C077", 0x1451, 1, 2, 0, 9999, 0, STOP, 0 },
  { "C078", 0x1452, 1, 0, 0, 1000, 0, STOP, 0 },
  { "C091", 0x145F, 1, 0, 0, 1, 0, STOP, 0 },       // M
  { "C101", 0x1469, 1, 0, 0, 1, 0, STOP, 0 },       // M
  { "C102", 0x146A, 1, 0, 0, 3, 0, RUN, 0 },        // M
  { "C103", 0x146B, 1, 0, 0, 2, 0, STOP, 0 },       // M
  { "C104", 0x146C, 1, 0, 0, 1, 0, STOP, 0 },       // M
  { "C111", 0x1473, 1, 1, 0, 2000, 1150, RUN, 0 },  // M
  { "C241", 0x2429, 1, 1, 0, 2000, 1150, RUN, 0 },  // M
  // H: motor. M
  { "H001", 0x1501, 1, 0, 0, 2, 0, STOP, 0 },
  { "H002", 0x1502, 1, 0, 0, 2, 0, STOP, 0 },
  { "H003", 0x1503, 1, 0, 0, 21, 5, STOP, 0 },
  { "H004", 0x1504, 1, 0, 0, 23, 1, STOP, 0 },
  { "P001", 0x1601, 1, 0, 0, 1, 0, STOP, 0 },
};

// Only the MX2, or there with another unit or range.
const std::vector<Parameter> MX2_ONLY = {
  { "A001", 0x1201, 1, 0, 0, 10, 2, STOP, 0x4DF },    // S/M: 0, 1, 2, 3, 4, 6, 7, 10
  { "A002", 0x1202, 1, 0, 1, 4, 2, STOP, 0 },         // S/M: 1, 2, 3, 4
  { "A003", 0x1203, 1, 1, 300, 4000, 500, STOP, 0 },  // S: 0.1 Hz
  { "A004", 0x1204, 1, 1, 300, 4000, 500, STOP, 0 },  // M: 0.1 Hz
  { "A203", 0x2203, 1, 1, 300, 4000, 500, STOP, 0 }, { "A204", 0x2204, 1, 1, 300, 4000, 500, STOP, 0 },
  { "A072", 0x1260, 1, 2, 0, 2500, 100, RUN, 0 },  // M: 0.01
  { "A261", 0x224F, 2, 2, 0, 40000, 0, STOP, 0 },    { "A262", 0x2251, 2, 2, 0, 40000, 0, STOP, 0 },
  { "A292", 0x2274, 2, 2, 1, 360000, 1000, RUN, 0 }, { "b049", 0x1333, 1, 0, 0, 1, 0, STOP, 0 },  // M
  { "b083", 0x1356, 1, 1, 20, 150, 100, STOP, 0 },                                                // M
  { "b166", 0x13A9, 1, 0, 0, 1, 0, STOP, 0 },                                                     // M
  { "b171", 0x13AE, 1, 0, 0, 3, 0, STOP, 0 },                                                     // M
  { "b180", 0x13B7, 1, 0, 0, 1, 0, STOP, 0 },                                                     // M
  { "C071", 0x144B, 1, 0, 3, 10, 5, STOP, 0 },                                                    // S
  { "C072", 0x144C, 1, 0, 1, 247, 1, STOP, 0 },                                                   // S
  { "C096", 0x1464, 1, 0, 0, 2, 0, STOP, 0 },                                                     // M
  { "H005", 0x1506, 1, 0, 1, 1000, 100, RUN, 0 },                                                 // M
  { "H006", 0x1507, 1, 0, 0, 255, 100, RUN, 0 },                                                  // M
  { "P044", 0x162E, 1, 2, 0, 9999, 100, STOP, 0 },  // the option network's watchdog, not the RS-485's
  { "P045", 0x162F, 1, 0, 0, 4, 0, STOP, 0 },        { "P200", 0x16C8, 1, 0, 0, 1, 0, STOP, 0 },  // M
  { "P400", 0x16F1, 1, 0, 0, 2, 0, STOP, 0 },                                                     // M
};

const std::vector<Parameter> RX_ONLY = {
  { "F302", 0x3103, 2, 2, 1, 360000, 1000, RUN, 0 },  // M
  { "F303", 0x3105, 2, 2, 1, 360000, 1000, RUN, 0 },  // M
  { "A001", 0x1201, 1, 0, 0, 10, 2, STOP, 0x4FF },    // S/M: MX2's and 5
  { "A002", 0x1202, 1, 0, 1, 5, 2, STOP, 0 },         // S/M
  { "A003", 0x1203, 1, 0, 30, 400, 50, STOP, 0 },     // S: 1 Hz (SJ700a p. 311, 0032h = 50 Hz)
  { "A004", 0x1204, 1, 0, 30, 400, 50, STOP, 0 },     // M: 1 Hz
  { "A203", 0x2203, 1, 0, 30, 400, 50, STOP, 0 },    { "A204", 0x2204, 1, 0, 30, 400, 50, STOP, 0 },
  { "A072", 0x1260, 1, 1, 2, 50, 10, RUN, 0 },        // M: 0.1
  { "A320", 0x3216, 2, 2, 0, 40000, 0, RUN, 0 },      // SJ700a
  { "b083", 0x1356, 1, 1, 5, 150, 50, STOP, 0 },      // M
  { "C008", 0x1408, 1, 0, 0, 255, 0xFF, STOP, 0 },    // M
  { "C018", 0x1412, 1, 0, 0, 1, 0, STOP, 0 },         // M
  { "C019", 0x1413, 1, 0, 0, 1, 0, STOP, 0 },         // M
  { "C023", 0x1417, 1, 0, 0, 255, 3, STOP, 0 },       // M
  { "C024", 0x1418, 1, 0, 0, 255, 7, STOP, 0 },       // M
  { "C025", 0x1419, 1, 0, 0, 255, 8, STOP, 0 },       // M
  { "C029", 0x141D, 1, 0, 0, 255, 0, STOP, 0 },       // M
  { "C071", 0x144B, 1, 0, 2, 6, 4, STOP, 0 },         // S
  { "C072", 0x144C, 1, 0, 1, 32, 1, STOP, 0 },        // S
  { "C073", 0x144D, 1, 0, 7, 8, 7, STOP, 0 },         // S, address MEM
  { "C079", 0x1453, 1, 0, 0, 1, 1, STOP, 0 },         // S, address MEM
  { "H005", 0x1506, 2, 3, 1, 80000, 1590, RUN, 0 },   // M: two words
  { "H020", 0x1516, 2, 3, 1, 65530, 1000, STOP, 0 },  // M
};

/// A row of registers of which the sources give no more than code and number (PYMX2, or memory).
struct Run
{
  const char* first_code;
  std::uint16_t number;
  int count;
  int words;
};

const std::vector<Run> COMMON_RUNS = {
  { "b015", 0x1310, 6, 1 },  // free thermal characteristic
  { "b050", 0x1334, 3, 1 }, { "b054", 0x1339, 1, 1 }, { "b120", 0x137B, 8, 1 },
  { "C011", 0x140B, 7, 1 }, { "C160", 0x14A4, 7, 1 }, { "C169", 0x14AD, 1, 1 },
};

const std::vector<Run> MX2_RUNS = {
  { "H020", 0x1516, 1, 1 },  { "H021", 0x1518, 1, 1 },  { "H022", 0x151A, 1, 1 },  { "H023", 0x151C, 1, 1 },
  { "H024", 0x151D, 1, 2 },  { "A046", 0x1240, 2, 1 },  { "A056", 0x124A, 1, 1 },  { "A059", 0x124D, 1, 1 },
  { "A077", 0x1265, 3, 1 },  { "A083", 0x126B, 2, 1 },  { "A086", 0x126E, 1, 1 },  { "A101", 0x1281, 2, 2 },
  { "A103", 0x1285, 3, 1 },  { "A131", 0x12A5, 2, 1 },  { "A150", 0x12B9, 4, 1 },  { "A154", 0x12BD, 1, 2 },
  { "A155", 0x12BF, 1, 1 },  { "A156", 0x12C0, 1, 2 },  { "A157", 0x12C2, 1, 1 },  { "A161", 0x12C6, 2, 2 },
  { "A163", 0x12CA, 3, 1 },  { "b028", 0x131D, 3, 1 },  { "b033", 0x1322, 1, 1 },  { "b034", 0x1323, 1, 2 },
  { "b036", 0x1326, 1, 1 },  { "b038", 0x1328, 2, 1 },  { "b045", 0x132F, 2, 1 },  { "b060", 0x133F, 6, 1 },
  { "b070", 0x1349, 2, 1 },  { "b075", 0x134E, 1, 1 },  { "b078", 0x1351, 2, 1 },  { "b089", 0x135C, 1, 1 },
  { "b092", 0x135F, 3, 1 },  { "b097", 0x1364, 1, 1 },  { "b100", 0x1367, 14, 1 }, { "b132", 0x1387, 3, 1 },
  { "b145", 0x1394, 1, 1 },  { "b150", 0x139A, 1, 1 },  { "b160", 0x13A3, 2, 1 },  { "b163", 0x13A6, 3, 1 },
  { "b221", 0x2316, 1, 1 },  { "b910", 0x13C6, 1, 1 },  { "b911", 0x13C7, 2, 2 },  { "b913", 0x13CB, 1, 1 },
  { "C030", 0x141E, 1, 1 },  { "C038", 0x1426, 2, 1 },  { "C047", 0x1433, 1, 1 },  { "C052", 0x1438, 8, 1 },
  { "C081", 0x1455, 2, 1 },  { "C085", 0x1459, 1, 1 },  { "C098", 0x1466, 3, 1 },  { "C105", 0x146D, 2, 1 },
  { "C109", 0x1471, 1, 1 },  { "C130", 0x1486, 4, 1 },  { "C140", 0x1490, 11, 1 }, { "H030", 0x1525, 1, 1 },
  { "H031", 0x1527, 1, 1 },  { "H032", 0x1529, 1, 1 },  { "H033", 0x152B, 1, 1 },  { "H034", 0x152C, 1, 2 },
  { "H050", 0x153D, 2, 1 },  { "H102", 0x1571, 8, 1 },  { "H110", 0x1579, 1, 2 },  { "H111", 0x157B, 3, 1 },
  { "H116", 0x1581, 4, 1 },  { "H121", 0x1586, 3, 1 },  { "H131", 0x158A, 4, 1 },  { "P003", 0x1603, 2, 1 },
  { "P011", 0x160B, 2, 1 },  { "P015", 0x160F, 1, 1 },  { "P017", 0x1611, 1, 1 },  { "P026", 0x161A, 2, 1 },
  { "P031", 0x161F, 1, 1 },  { "P033", 0x1621, 2, 1 },  { "P036", 0x1624, 3, 1 },  { "P039", 0x1627, 2, 2 },
  { "P041", 0x162B, 1, 1 },  { "P046", 0x1630, 1, 1 },  { "P048", 0x1632, 2, 1 },  { "P055", 0x1639, 5, 1 },
  { "P060", 0x163E, 8, 2 },  { "P068", 0x164E, 4, 1 },  { "P072", 0x1652, 2, 2 },  { "P075", 0x1657, 1, 1 },
  { "P077", 0x1659, 1, 1 },  { "P080", 0x165C, 3, 1 },  { "P083", 0x1660, 1, 2 },  { "P100", 0x1666, 32, 1 },
  { "P140", 0x168E, 16, 1 }, { "P160", 0x16A2, 10, 1 }, { "P170", 0x16AC, 10, 1 },
};

std::string nextCode(const std::string& code, int step)
{
  char text[8];
  std::snprintf(text, sizeof(text), "%c%03d", code[0], std::stoi(code.substr(1)) + step);
  return text;
}

void append(std::vector<Parameter>& table, const std::vector<Run>& runs)
{
  for (const Run& run : runs)
  {
    for (int i = 0; i < run.count; ++i)
    {
      table.push_back({ nextCode(run.first_code, i), static_cast<std::uint16_t>(run.number + i * run.words), run.words,
                        0, 0, run.words == 2 ? W2 : W1, 0, STOP, 0 });
    }
  }
}

/// A021-A035, multi-speeds 1-15: 1218h + 2 (n - 21), 0.01 Hz.
void appendMultiSpeeds(std::vector<Parameter>& table)
{
  for (int i = 0; i < 15; ++i)
  {
    table.push_back({ nextCode("A021", i), static_cast<std::uint16_t>(0x1218 + 2 * i), 2, 2, 0, 40000, 0, RUN, 0 });
  }
}
/// The ten slots of the Modbus mapping: see RegisterMap. Ranges: Hitachi WJ200 p. 532; that they are locked while the motor
/// runs: M.
void appendMapping(std::vector<Parameter>& table)
{
  const auto number = [](int first, int slot) { return static_cast<std::uint16_t>(first + slot); };
  for (int slot = 0; slot < 10; ++slot)
  {
    table.push_back({ nextCode("P201", slot), number(0x16C9, slot), 1, 0, 0, W1, 0, STOP, 0 });     // external number
    table.push_back({ nextCode("P211", slot), number(0x16D3, slot), 1, 0, 0, 1, 0, STOP, 0 });      // 1: signed
    table.push_back({ nextCode("P221", slot), number(0x16DD, slot), 1, 3, 1, W1, 1000, STOP, 0 });  // ratio
    table.push_back({ nextCode("P301", slot), number(0x16E7, slot), 1, 0, 0, W1, 0, STOP, 0 });     // internal number
  }
}
}  // namespace

std::vector<Parameter> mx2Parameters()
{
  std::vector<Parameter> table = COMMON;
  table.insert(table.end(), MX2_ONLY.begin(), MX2_ONLY.end());
  appendMapping(table);
  appendMultiSpeeds(table);
  append(table, COMMON_RUNS);
  append(table, MX2_RUNS);
  return table;
}

std::vector<Parameter> rxParameters()
{
  std::vector<Parameter> table = COMMON;
  table.insert(table.end(), RX_ONLY.begin(), RX_ONLY.end());
  appendMultiSpeeds(table);
  append(table, COMMON_RUNS);
  return table;
}
}  // namespace simulation
}  // namespace inverter_bus
