"""Gateways of plain sockets between the driver and a simulated bus, with what real ones do wrong at will."""
import os
import select
import socket
import struct
import threading
import time
import tty

SILENCE = 0.3  # [s] without a reply after which a gateway answers by itself


def crc(data):
    """The two check bytes of a Modbus RTU frame, low byte first."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return struct.pack('<H', value)


class Gateway:
    """Listens on a port of its own, one client at a time, as small serial servers do."""

    def __init__(self, link):
        self.line = os.open(link, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.line)
        self.port = 0
        self.clients = 0
        self.up()

    def up(self):
        """Listens, on the same port as before; until then connections are refused."""
        self.listener = socket.socket()
        self.listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.listener.bind(('127.0.0.1', self.port))
        self.listener.listen(1)
        self.port = self.listener.getsockname()[1]
        self.ended = False
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def down(self):
        """Closes the connection and listens no more, as a gateway that is switched off."""
        self.ended = True
        self.thread.join()
        self.listener.close()

    def run(self):
        while not self.ended:
            if not select.select([self.listener], [], [], 0.05)[0]:
                continue
            client = self.listener.accept()[0]
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.clients += 1
            try:
                while not self.ended:
                    self.serve(client)
            except OSError:
                pass  # the client has gone
            client.close()

    def serve(self, client):
        """Passes on what there is, waiting for at most a moment; raises OSError when the connection is gone."""
        raise NotImplementedError

    def receive(self, client, wait):
        if not select.select([client], [], [], wait)[0]:
            return b''
        data = client.recv(4096)
        if not data:
            raise OSError('closed by the client')
        return data

    def close(self):
        self.down()
        os.close(self.line)


class ByteBridge(Gateway):
    """A serial server: bytes in, bytes out."""

    def serve(self, client):
        ready = select.select([client, self.line], [], [], 0.05)[0]
        if client in ready:
            os.write(self.line, self.receive(client, 0.0))
        if self.line in ready:
            client.sendall(os.read(self.line, 4096))


class ModbusGateway(Gateway):
    """A Modbus TCP gateway: the frame without its header goes onto the line, with a check sum."""

    def __init__(self, link):
        self.before_answer = None  # called with number, request and reply; gives what goes before the reply
        self.strangers = 0         # how often something went before an answer
        super().__init__(link)

    def serve(self, client):
        self.rest += self.receive(client, 0.05)
        while len(self.rest) >= 6 and len(self.rest) >= 6 + struct.unpack('>H', self.rest[4:6])[0]:
            number, protocol, length = struct.unpack('>HHH', self.rest[:6])
            frame, self.rest = self.rest[6:6 + length], self.rest[6 + length:]
            self.answer(client, number, protocol, frame)

    def up(self):
        self.rest = b''
        super().up()

    def answer(self, client, number, protocol, frame):
        reply = self.exchange(frame)
        if frame[0] == 0:
            return  # a broadcast
        reply = reply or bytes([frame[0], frame[1] | 0x80, 0x0B])
        if self.before_answer:
            stranger = self.before_answer(number, frame, reply)
            self.strangers += bool(stranger)
            client.sendall(stranger)
        client.sendall(struct.pack('>HHH', number, protocol, len(reply)) + reply)

    def exchange(self, frame):
        """One exchange on the line; empty after silence."""
        os.write(self.line, frame + crc(frame))
        answer = b''
        deadline = time.monotonic() + SILENCE
        while frame[0] != 0 and time.monotonic() < deadline:
            if select.select([self.line], [], [], 0.02)[0]:
                answer += os.read(self.line, 4096)
                if len(answer) >= 5 and crc(answer[:-2]) == answer[-2:]:
                    time.sleep(0.003)  # 3.5 characters, which the drive wants before the next request
                    return answer[:-2]
        return b''
