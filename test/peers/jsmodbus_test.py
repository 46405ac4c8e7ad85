#!/usr/bin/env python3
"""The driver on tcp:// against npm's jsmodbus, which knows no units: a broadcast is answered too."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from node_servers import NodeServer, missing
from remote_drives import ItsCases, RemoteDrives

MISSING = missing('jsmodbus')


@unittest.skipIf(MISSING, MISSING)
class Jsmodbus(ItsCases, RemoteDrives):
    one_table = True

    @classmethod
    def startServer(cls):
        cls.server = NodeServer('jsmodbus_mx2.js')
        cls.addClassCleanup(cls.server.end)
        return cls.server.port

    def drive(self, _):
        return self.server.drives[1]


if __name__ == '__main__':
    unittest.main(warnings='ignore')  # rospy leaves sockets to the garbage collector
