// A few coils and registers of an MX2 whose motor needs no time: status and output follow the commands at once. The
// numbers are those on the wire, one less than the manual's.
'use strict';

const COIL = { run: 0x0000, direction: 0x0001, operation: 0x000e, ready: 0x0010, running: 0x0012, atSpeed: 0x0013 };
const REGISTER = { frequency: 0x0000, output: 0x1000, A001: 0x1200, A002: 0x1201 };
const COILS = 0x0060;
const REGISTERS = 0x1300;

/** What it must show after a write; `coil` and `register` get the value at a number, or set it. */
function follow(unit, coil, register) {
  const run = coil(COIL.run);
  const reverse = coil(COIL.direction);
  for (const number of [COIL.operation, COIL.running, COIL.atSpeed]) coil(number, run);
  coil(COIL.ready, true);
  register(REGISTER.A001, 3);
  register(REGISTER.A002, 3);
  const frequency = [register(REGISTER.frequency), register(REGISTER.frequency + 1)];
  const output = run ? [...frequency, 150, reverse ? 2 : 1] : [0, 0, 0, 0];
  output.forEach((value, n) => register(REGISTER.output + n, value));
  console.log(JSON.stringify({ unit, run, reverse, frequency: frequency[0] * 65536 + frequency[1] }));
}

module.exports = { follow, COILS, REGISTERS };
