"""Which drives stand on a bus, as the scan list that the driver and the simulated drives share; benchmark/scene.h has the same."""
import collections

Scene = collections.namedtuple('Scene', 'inverters baud drive mapped')
Scene.__new__.__defaults__ = (False,)
Scene.__doc__ = """A bus of equal drives at stations 1 to `inverters`, 8N1. mapped: MX2 whose register map is set and may be used."""

REPLY_DELAY = 0.005
"""[s] from the end of a request to its reply, the drive's silence of 3.5 characters included."""

SCENES = [Scene(1, 19200, 'omron_mx2'), Scene(5, 19200, 'omron_mx2'), Scene(31, 19200, 'omron_mx2'),
          Scene(8, 9600, 'omron_mx2'), Scene(8, 115200, 'omron_mx2'), Scene(1, 19200, 'toshiba_vfs15')]
MAPPED = Scene(5, 19200, 'omron_mx2', True)
BLOCK = '{F870: 1, F871: 3, F875: 1, F876: 2, F877: 3, F878: 4, F879: 14}'
MAP = '{P200: 1, P201: 4101, P202: 4102, P301: 7681, P302: 7937}'


def title(scene):
    """'5 MX2, 19200'."""
    return '%d %s, %d' % (scene.inverters, {'omron_mx2': 'MX2', 'toshiba_vfs15': 'VF-S15'}[scene.drive], scene.baud)


def silence(baud):
    """3.5 characters of 10 bits; above 19200 baud 1.75 ms [s]."""
    return 0.00175 if baud > 19200 else 35.0 / baud


def warm_up(scene):
    """[s] in which a driver has certainly read the settings of all drives."""
    return 5.0 + 0.7 * scene.inverters * 19200.0 / min(scene.baud, 19200)


def scan_list(scene, port):
    """YAML."""
    nodes = range(1, scene.inverters + 1)
    turnaround = max(0.0, REPLY_DELAY - silence(scene.baud))
    parameters = BLOCK if scene.drive == 'toshiba_vfs15' else MAP if scene.mapped else '{}'
    keys = ', configure_map: true, confirm: [register_map]' if scene.mapped else ''
    return ''.join(['port: %s\nbaud_rate: %d\n' % (port, scene.baud),
                    'defaults: {drive: %s, command_timeout: 0%s}\n' % (scene.drive, keys), 'scan_list:\n'] +
                   ['  - {name: belt_%d, node: %d}\n' % (node, node) for node in nodes] + ['simulation:\n'] +
                   ['  belt_%d: {turnaround: %.6f, parameters: %s}\n' % (node, turnaround, parameters) for node in nodes])
