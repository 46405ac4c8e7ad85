// modbus-serial's server with two MX2, units 1 and 2. What goes to unit 0 goes to both of them.
'use strict';

const { ServerTCP } = require('modbus-serial');
const { follow, COILS, REGISTERS } = require('./mx2_table');

const units = {};
for (const unit of [1, 2]) {
  units[unit] = { coils: new Array(COILS).fill(false), registers: new Array(REGISTERS).fill(0) };
}

function update(unit) {
  const { coils, registers } = units[unit];
  const access = (table) => (number, value) => (value === undefined ? table[number] : (table[number] = value));
  follow(unit, access(coils), access(registers));
}

function read(kind, number, unit) {
  const table = units[unit][kind];
  if (number >= table.length) throw Object.assign(new Error('no such number'), { modbusErrorCode: 2 });
  return table[number];
}

function write(kind, number, value, unit) {
  for (const one of unit === 0 ? [1, 2] : [unit]) {
    units[one][kind][number] = value;
    update(one);
  }
}

const server = new ServerTCP(
  {
    getCoil: (number, unit) => read('coils', number, unit),
    getHoldingRegister: (number, unit) => read('registers', number, unit),
    setCoil: (number, value, unit) => write('coils', number, value, unit),
    setRegister: (number, value, unit) => write('registers', number, value, unit),
  },
  { host: '127.0.0.1', port: Number(process.argv[2]) }
);
server.on('initialized', () => [1, 2].forEach(update));
