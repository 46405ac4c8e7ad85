#!/usr/bin/env python3
"""The plain loop with pymodbus: two reads per MX2, one drive after the other.

    pymodbus_loop.py DEVICE BAUD INVERTERS SECONDS

A line "stop N" on standard input takes RUN off at station N when its turn comes, before its reads.
"""
import logging
import os
import sys
import time

from pymodbus.client import ModbusSerialClient


class Loop:
    def __init__(self, device, baud):
        # Its time-outs are whole seconds: 0.5 would be 0 (findings/pymodbus_timeout_in_whole_seconds.sh).
        self.client = ModbusSerialClient(device, method='rtu', baudrate=baud, parity='N', stopbits=1, bytesize=8, timeout=1,
                                         retries=0)
        self.text = b''
        self.stops = set()
        if not self.client.connect():
            raise SystemExit('%s can\'t be opened' % device)
        os.set_blocking(0, False)

    def read_commands(self):
        try:
            self.text += os.read(0, 256)
        except BlockingIOError:
            return
        *lines, self.text = self.text.split(b'\n')
        self.stops |= {int(line.split()[1]) for line in lines if line.startswith(b'stop ')}

    def serve(self, station):
        """The client takes a lost answer for an exception; the loop goes on all the same."""
        self.read_commands()
        if station in self.stops:
            self.stops.discard(station)
            self.client.write_coil(0, False, slave=station)
        self.client.read_coils(0, 24, slave=station)
        self.client.read_holding_registers(0x1000, 4, slave=station)


def main():
    logging.disable(logging.CRITICAL)
    device, baud, inverters, seconds = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4])
    loop = Loop(device, baud)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for station in range(1, inverters + 1):
            loop.serve(station)


if __name__ == '__main__':
    main()
