#!/usr/bin/env python3
"""`make install` into an empty directory: the installed tree runs by itself, with its own profiles and launch files."""
import glob
import os
import re
import shutil
import socket
import subprocess
import tempfile
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.environ.get('INVERTER_BUS_BUILD', os.path.join(ROOT, 'build', 'test'))


def free_port():
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


class InstalledTree(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.prefix = tempfile.mkdtemp(prefix='inverter_bus_install_')
        subprocess.run(['cmake', '--install', BUILD, '--prefix', cls.prefix], check=True, stdout=subprocess.DEVNULL)
        cls.share = os.path.join(cls.prefix, 'share', 'inverter_bus')
        cls.environment = {'PATH': '/usr/bin:/bin', 'HOME': cls.prefix, 'ROS_LOG_DIR': os.path.join(cls.prefix, 'log'),
                           'ROS_MASTER_URI': 'http://127.0.0.1:%d' % free_port(), 'ROS_IP': '127.0.0.1'}
        # A profile that only the installed tree has.
        drives = os.path.join(cls.share, 'config', 'drives')
        with open(os.path.join(drives, 'omron_mx2.yaml')) as shipped:
            own = re.sub(r'^drive: omron_mx2$', 'drive: only_here', shipped.read(), flags=re.MULTILINE)
        with open(os.path.join(drives, 'only_here.yaml'), 'w') as copy:
            copy.write(own)
        cls.master = subprocess.Popen(['bash', '-c', cls.in_tree('exec rosmaster --core -p %s' %
                                                                  cls.environment['ROS_MASTER_URI'].rsplit(':')[-1])],
                                      env=cls.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.master.terminate()
        cls.master.wait()
        shutil.rmtree(cls.prefix)

    @classmethod
    def in_tree(cls, command):
        """Debian's catkin installs no setup.bash: the tree is then added by hand, as README says."""
        noetic, own = '/opt/ros/noetic/setup.bash', os.path.join(cls.prefix, 'setup.bash')
        lines = ['source ' + noetic] if os.path.exists(noetic) else []
        if os.path.exists(own):
            lines.append('source ' + own)
        else:
            python = glob.glob(os.path.join(cls.prefix, 'lib', 'python3*', '*-packages'))[0]
            lines.append('export ROS_PACKAGE_PATH=%s/share:/usr/share CMAKE_PREFIX_PATH=%s PYTHONPATH=%s' %
                         (cls.prefix, cls.prefix, python))
        return ' && '.join(lines + [command])

    def run_in_tree(self, command):
        return subprocess.run(['bash', '-c', self.in_tree(command)], env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True, timeout=60)

    def testItHoldsLaunchFilesScanListsAndProfiles(self):
        for folder in ('launch', 'config'):
            for path, _, files in os.walk(os.path.join(ROOT, folder)):
                for name in files:
                    relative = os.path.relpath(os.path.join(path, name), ROOT)
                    self.assertTrue(os.path.exists(os.path.join(self.share, relative)), relative)

    def testItsProgramsAreFoundByRosrun(self):
        answer = self.run_in_tree('rosrun inverter_bus check_profile %s/config/drives/only_here.yaml' % self.share)
        self.assertEqual(answer.returncode, 0, answer.stdout)
        answer = self.run_in_tree('rosrun inverter_bus check_profile /no/such/file.yaml')
        self.assertNotEqual(answer.returncode, 0)

    def scan_lists(self, launch):
        """Arguments that a launch file does not start without: which line it is for."""
        files = {'bus.launch': {'config': 'conveyor_line'},
                 'multi_bus.launch': {'line_config': 'conveyor_line', 'robot_config': 'diff_drive_robot'}}
        return ['%s:=%s/config/%s.yaml' % (argument, self.share, name)
                for argument, name in files.get(launch, {}).items()]

    def testAMisspeltArgumentStartsNoOtherLine(self):
        for launch in ('bus.launch', 'multi_bus.launch'):
            answer = self.run_in_tree('roslaunch --nodes inverter_bus %s confg:=%s/config/conveyor_line.yaml' %
                                      (launch, self.share))
            self.assertNotEqual(answer.returncode, 0, answer.stdout)
            self.assertIn('config', answer.stdout)

    def testItsLaunchFilesAreComplete(self):
        for name in sorted(os.listdir(os.path.join(self.share, 'launch'))):
            answer = self.run_in_tree('roslaunch --nodes inverter_bus %s %s' % (name, ' '.join(self.scan_lists(name))))
            self.assertEqual(answer.returncode, 0, answer.stdout)

    def node(self, drive):
        self.run_in_tree('until rosparam list; do sleep 0.1; done')
        self.run_in_tree('rosparam set /installed "{port: %s/no_port, trace_directory: %s, scan_list: '
                         '[{name: belt, node: 1, drive: %s}]}"' % (self.prefix, self.prefix, drive))
        return subprocess.Popen(['bash', '-c', self.in_tree('exec rosrun inverter_bus inverter_bus_node '
                                                            '__name:=installed')],
                                env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                universal_newlines=True)

    def testAWrongConfigurationEndsTheNode(self):
        process = self.node('no_such_drive')
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, output)
        self.assertIn('no_such_drive', output)

    def testItsOwnProfilesAreUsed(self):
        process = self.node('only_here')
        answer = None
        deadline = time.monotonic() + 30.0
        while time.monotonic() < deadline and process.poll() is None:
            answer = self.run_in_tree('timeout 20 rostopic echo -n 1 /installed/belt/status/drive')
            if answer.returncode == 0:
                break
        process.terminate()
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, output)
        self.assertIn('only_here', answer.stdout)


if __name__ == '__main__':
    unittest.main()
