"""What was on the simulated wire: reads the trace of simulated_bus, and says how often what came. No I/O."""
import collections

from figures import median

Frame = collections.namedtuple('Frame', 'time sender station bytes remark')
"""time: of its first byte [s of CLOCK_MONOTONIC]; sender: master, drive, foreign or noise."""

FREQUENCY = {0x1000, 0xFD00, 0x1875}
"""Registers (as in the frame) that every refresh reads: the output frequency of MX2 and VF-S15, and the VF-S15's block."""


def parse(text):
    """Frames of a trace whose first line tells when its time began."""
    begin, frames = 0.0, []
    for line in text.splitlines():
        if line.startswith('# 0 is '):
            begin = float(line.split()[3])
            continue
        body, _, remark = line.partition(' # ')
        words = body.split(None, 3)
        if len(words) == 4:
            frames.append(Frame(begin + float(words[0]), words[1], words[2], bytes.fromhex(words[3]), remark.strip()))
    return frames


def reads_frequency(frame):
    """Is it a request (03H, 04H or 17H) that reads one of FREQUENCY?"""
    data = frame.bytes
    if frame.sender != 'master' or len(data) < 8 or data[1] not in (0x03, 0x04, 0x17):
        return False
    first = data[2] * 256 + data[3]
    return any(first <= address < first + data[4] * 256 + data[5] for address in FREQUENCY)


def periods(frames, chosen=reads_frequency):
    """[s] between two chosen requests to the same station, by station."""
    last, found = {}, collections.defaultdict(list)
    for frame in frames:
        if chosen(frame):
            if frame.station in last:
                found[frame.station].append(frame.time - last[frame.station])
            last[frame.station] = frame.time
    return dict(found)


def cycle(frames):
    """Median [s] between two refreshes of a station. Who reads none of FREQUENCY is taken by its most frequent request."""
    found = [period for of_one in periods(frames).values() for period in of_one]
    if len(found) < 3:
        count = collections.Counter(frame.bytes for frame in frames if frame.sender == 'master')
        if not count:
            return None
        usual = count.most_common(1)[0][0]
        found = [period for of_one in periods(frames, lambda frame: frame.bytes == usual).values() for period in of_one]
    return median(found)


def wire_use(frames, baud, duration):
    """Share of the time in which there were bytes on the wire."""
    return sum(len(frame.bytes) for frame in frames) * 10.0 / baud / duration if duration > 0 else None


def early_share(frames):
    """Share of the master's requests that came before 3.5 characters of silence."""
    requests = [frame for frame in frames if frame.sender == 'master']
    return sum(frame.remark.startswith('early') for frame in requests) / len(requests) if requests else None


def within(frames, begin, end):
    return [frame for frame in frames if begin <= frame.time < end]


def delay_to(frames, since, wanted):
    """[s] from an instant to the first of the master's frames for which wanted(bytes) holds; -1: none."""
    for frame in frames:
        if frame.sender == 'master' and frame.time >= since and wanted(frame.bytes):
            return frame.time - since
    return -1.0
