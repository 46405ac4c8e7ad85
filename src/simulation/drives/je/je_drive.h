// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_JE_DRIVE_H
#define INVERTER_BUS_SIMULATION_JE_DRIVE_H

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "inverter_bus/simulation/drive_options.h"
#include "simulation/drives/brand_drive.h"

namespace inverter_bus
{
namespace simulation
{
/// An OMRON 3G3JE (200 V, 0.2 kW) with its motor, on CompoWay/F.
///
/// From its communications manual I548: frames and services (CompowaySlave), the areas C0, C1 and C3, parameters
/// C3/0000-000B, the two setup areas, the two write modes, and that C3/0009 = 1 disables RUN and STOP by
/// communications.
///
/// **Invented for the simulation,** because those pages of the manual are lost; a driver must not rely on any of it
/// without its user's word:
/// - the codes of service 30 05 (see the source; DriveOptions::operation_codes replaces them): none is that of a sister
///   device, so that a driver that guesses them fails;
/// - the address and the bits of the status word C0/0003: 0 over-current, 1 over-voltage, 2 under-voltage, 3 motor
///   overheated, 7 fin overheated, 8 fan, 9 braking IGBT, 12 charged, 13 running, 14 reverse, 15 tripped; `NAME trip N`
///   with N = 1 ... 7 sets the fault bits in this order, others bit 15 alone;
/// - C0/0000 shows the reference too; C1 ends after 0000; C3 after 000B;
/// - taking over at the panel: C3/0009 becomes 1 and the terminals run the motor, the only way that the manual shows;
/// - ramps, which only the panel sets: `acceleration` and `deceleration` [s].
///
/// Where the manual is silent: the reference is limited by C3/0005-0007 when it is used, not when it is written; the
/// EEPROM's reference returns after power-on, and the return from RAM to Backup mode stores (OMRON's E5 series does);
/// setup area 1 ends RUN for good and lets no RUN in (2203), nor does C3/0009 = 1; the write mode can't be changed
/// there (2203); a trip keeps RUN; `busy` refuses writes (2203) and nothing else; a write to the EEPROM takes no time;
/// C3/0008 = 2 lets the motor run on after any power cut; nothing happens when the communication ends.
class JeDrive final : public BrandDrive<CompowaySlave>
{
public:
  /// \throws std::invalid_argument for an unknown parameter, a value out of its range, a baud rate or station that the
  /// drive doesn't have, or operation codes that can't be; the text names it
  explicit JeDrive(const DriveOptions& options);

  bool runCommand() const override;

protected:
  void losePower() override;
  void gainPower() override;
  void control() override;
  void doTrip(int code) override;
  int overcurrentTrip() const override;
  double ratedCurrent() const override;
  Refusal stopByKey() override;
  void describeBrand(ShowList& list) const override;

  Duration replyDelay() const override;
  bool hasArea(std::uint8_t type) const override;
  bool hasAddress(std::uint8_t type, std::uint32_t address) const override;
  bool readOnly(std::uint8_t type) const override;
  Response readVariables(std::uint8_t type, std::uint32_t address, std::size_t count,
                         std::vector<std::uint32_t>& values) override;
  bool accepts(std::uint8_t type, std::uint32_t address, const std::vector<std::uint32_t>& values) const override;
  Response writeVariables(std::uint8_t type, std::uint32_t address, const std::vector<std::uint32_t>& values) override;
  Response operate(const std::string& code) override;
  std::string controllerStatus() const override;

private:
  enum class Run
  {
    Off,
    Forward,
    Reverse
  };

  // je_drive.cpp: commissioning, control, by hand
  void commissionLine();
  LineSettings serialInEffect() const;
  bool busCommands() const;
  bool busRuns() const;
  double wantedFrequency() const;
  void setRun(Run run);

  // je_services.cpp
  void buildOperations();
  std::uint32_t monitor(std::uint32_t address) const;
  std::uint32_t status() const;
  Response changeRun(Run run);
  Response changeWriteMode(bool ram);
  Response changeArea(int area);
  Response resetTrip();

  std::map<std::string, std::string> operations_;  // name by code
  Run run_ = Run::Off;
  Run run_before_power_cut_ = Run::Off;
  TimePoint power_cut_;
  bool ram_mode_ = false;
  int area_ = 0;
  bool stop_key_ = false;  // stays stopped until RUN was off

  struct Codes
  {
    Index p01, p06, p07, p08, p09, p10, p15, p16, p17, p18, p19, reference, acceleration, deceleration;
  };
  Codes code_{};
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_JE_DRIVE_H
