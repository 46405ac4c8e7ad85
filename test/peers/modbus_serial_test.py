#!/usr/bin/env python3
"""The driver on tcp:// against npm's modbus-serial, which answers broadcasts as it does anything else."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from node_servers import NodeServer, missing
from remote_drives import ItsCases, RemoteDrives

MISSING = missing('modbus-serial')


@unittest.skipIf(MISSING, MISSING)
class ModbusSerial(ItsCases, RemoteDrives):
    @classmethod
    def startServer(cls):
        cls.server = NodeServer('modbus_serial_mx2.js')
        cls.addClassCleanup(cls.server.end)
        return cls.server.port

    def drive(self, node):
        return self.server.drives[node]


if __name__ == '__main__':
    unittest.main(warnings='ignore')  # rospy leaves sockets to the garbage collector
