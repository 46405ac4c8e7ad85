// jsmodbus's server with an MX2 in its one table, which it shows under every unit.
'use strict';

const network = new (require('net').Server)();
const modbus = require('jsmodbus');
const { follow, COILS, REGISTERS } = require('./mx2_table');

const coils = Buffer.alloc(COILS / 8);
const registers = Buffer.alloc(REGISTERS * 2);

function coil(number, value) {
  const mask = 1 << number % 8;
  if (value !== undefined) coils[number >> 3] = value ? coils[number >> 3] | mask : coils[number >> 3] & ~mask;
  return (coils[number >> 3] & mask) !== 0;
}

function register(number, value) {
  if (value !== undefined) registers.writeUInt16BE(value, number * 2);
  return registers.readUInt16BE(number * 2);
}

const update = () => follow(1, coil, register);
const server = new modbus.server.TCP(network, { coils, holding: registers });
for (const kind of ['SingleCoil', 'SingleRegister', 'MultipleCoils', 'MultipleRegisters']) {
  server.on('postWrite' + kind, update);
}
network.listen(Number(process.argv[2]), '127.0.0.1', update);
