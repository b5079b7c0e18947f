#!/usr/bin/env python3
"""Prints the pose track of a recording as a table: step,time,body,px,py,pz,qx,qy,qz,qw,awake, where p is the body's origin.

Written from docs/recording.md alone, with nothing of the engine: a test compares what it reads with what was simulated, so it also
shows that the page says all there is to know.

  recording_to_csv.py FILE.gyrec [--every N] [--bodies | --vertices]

  --bodies: a table of what the bodies look like instead
  --vertices: step,time,soft,vertex,px,py,pz of the vertices of ropes, cloths and solids instead
"""

import math
import struct
import sys

START, GEOMETRY, MODEL, KEYFRAME, FRAME, LABEL, NOTE = range(256, 263)
SOFT, VERTICES, SOFT_LABEL = range(264, 267)
MASK = (1 << 64) - 1


def xxh64(data):
    """The published XXH64 with seed 0."""
    p1, p2, p3, p4, p5 = (0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5)

    def rotl(x, r):
        return (x << r | x >> (64 - r)) & MASK

    def round_(lane, word):
        return rotl((lane + word * p2) & MASK, 31) * p1 & MASK

    place, size = 0, len(data)
    if size >= 32:
        lanes = [(p1 + p2) & MASK, p2, 0, -p1 & MASK]
        while place + 32 <= size:
            lanes = [round_(lane, word) for lane, word in zip(lanes, struct.unpack_from("<4Q", data, place))]
            place += 32
        value = sum(rotl(lane, r) for lane, r in zip(lanes, (1, 7, 12, 18))) & MASK
        for lane in lanes:
            value = ((value ^ round_(0, lane)) * p1 + p4) & MASK
    else:
        value = p5
    value = (value + size) & MASK
    while place + 8 <= size:
        value = (rotl(value ^ round_(0, struct.unpack_from("<Q", data, place)[0]), 27) * p1 + p4) & MASK
        place += 8
    if place + 4 <= size:
        value = (rotl(value ^ struct.unpack_from("<I", data, place)[0] * p1 & MASK, 23) * p2 + p3) & MASK
        place += 4
    for byte in data[place:]:
        value = rotl(value ^ byte * p5 & MASK, 11) * p1 & MASK
    value = (value ^ value >> 33) * p2 & MASK
    value = (value ^ value >> 29) * p3 & MASK
    return value ^ value >> 32


def chunks(data):
    """(kind, payload) up to the first chunk that is not whole."""
    place = 24
    number = 0
    while place + 24 <= len(data):
        kind, found, size, checksum = struct.unpack_from("<IIQQ", data, place)
        payload = data[place + 24:place + 24 + size]
        if found != number or len(payload) != size or checksum != xxh64(data[place:place + 16] + payload):
            return
        yield kind, payload
        place += 24 + size
        number += 1


class Bits:
    def __init__(self, data):
        self.word = int.from_bytes(data, "little")
        self.left = 8 * len(data)

    def bits(self, count):
        if count > self.left:
            raise ValueError("a frame ends too soon")
        value = self.word & ((1 << count) - 1)
        self.word >>= count
        self.left -= count
        return value

    def count(self, order):
        zeros = 0
        while not self.bits(1):
            zeros += 1
        return (1 << (order + zeros)) + self.bits(order + zeros) - (1 << order)


def unfold(folded):
    return -(folded >> 1) - 1 if folded & 1 else folded >> 1


class Body:
    def __init__(self, generation, model, flags, position, quaternion):
        self.generation, self.model = generation, model
        self.set_flags(flags)
        self.now = self.before = (position, quaternion)
        self.sizes = [None] * 6

    def set_flags(self, flags):
        self.awake, self.active = flags & 1, flags >> 1


class Soft:
    def __init__(self, generation, surface):
        self.generation, self.surface = generation, surface
        self.now = self.before = None
        self.sizes = [None] * 3


class Track:
    def __init__(self, data):
        if data[:8] != b"GYREPLAY":
            raise ValueError("this is no recording")
        if struct.unpack_from("<I", data, 8)[0] != 1:
            raise ValueError("this recording is of another version than 1")
        self.frames, self.models, self.labels, self.notes = [], [], {}, {}
        self.vertex_counts, self.soft_labels = [], {}
        self.position_bits = None
        vertices = None
        for kind, payload in chunks(data):
            if kind == START:
                version, self.position_bits, self.orientation_bits = struct.unpack_from("<IbB", payload)
                if version != 1:
                    raise ValueError("this track is of another version than 1")
            elif kind in (KEYFRAME, FRAME):
                self.frames.append((kind == KEYFRAME, payload, vertices))
                vertices = None
            elif kind == MODEL:
                self.models.append(payload)
            elif kind == SOFT:
                self.vertex_counts.append(struct.unpack_from("<I", payload, 5)[0])
            elif kind == VERTICES:
                vertices = payload
            elif kind in (LABEL, SOFT_LABEL):
                index, generation, size = struct.unpack_from("<IHQ", payload)
                labels = self.labels if kind == LABEL else self.soft_labels
                labels[index, generation] = payload[14:14 + size].decode("utf-8", "replace")
        if self.position_bits is None:
            raise ValueError("this recording holds no poses")

    def complete(self, quaternion, largest):
        others = sum(part * part for i, part in enumerate(quaternion) if i != largest)
        rest = (1 << 2 * self.orientation_bits) - others
        root = math.isqrt(rest)
        quaternion[largest] = root + (rest - root * root > root)
        return quaternion

    def pose_by_itself(self, bits):
        position = [unfold(bits.count(16)) for _ in range(3)]
        largest = bits.bits(2)
        one = 1 << self.orientation_bits
        quaternion = [0 if i == largest else bits.bits(self.orientation_bits + 2) - one for i in range(4)]
        return position, self.complete(quaternion, largest)

    @staticmethod
    def difference(bits, sizes, component):
        size = sizes[component]
        k = 8
        if size is not None:
            k = 0
            while 12 << k < size:
                k += 1
        high = 0
        while high < 24 and bits.bits(1):
            high += 1
        value = unfold(bits.bits(bits.bits(6)) if high == 24 else high << k | bits.bits(k))
        sizes[component] = 64 if size is None else size + ((16 * abs(value) - size + 1) >> 1)
        return value

    def next_pose(self, bits, body):
        (now_p, now_q), (before_p, before_q) = body.now, body.before
        position = [2 * a - b + self.difference(bits, body.sizes, i) for i, (a, b) in enumerate(zip(now_p, before_p))]
        dot = sum(a * b for a, b in zip(now_q, before_q))
        shift = 2 * self.orientation_bits
        expected = [((2 * dot * a + (1 << (shift - 1))) >> shift) - b for a, b in zip(now_q, before_q)]
        largest = max(range(4), key=lambda i: (abs(expected[i]), -i))
        if bits.bits(1):
            largest = bits.bits(2)
        sign = -1 if expected[largest] < 0 else 1
        quaternion, component = [0] * 4, 3
        for i in range(4):
            if i != largest:
                quaternion[i] = sign * expected[i] + self.difference(bits, body.sizes, component)
                component += 1
        body.before, body.now = body.now, (position, self.complete(quaternion, largest))

    def play(self):
        """(step, time, bodies by index) of each frame."""
        bodies = {}
        for is_keyframe, payload, _ in self.frames:
            step, time, _ = struct.unpack_from("<QdQ", payload)
            bits = Bits(payload[24:])
            if is_keyframe:
                bodies = {}
            index, put = -1, set()
            for _ in range(bits.count(0)):
                index += 1 + bits.count(4)
                change = bits.bits(2)
                if change == 0:
                    del bodies[index]
                elif change == 1:
                    generation, model, flags = bits.bits(16), bits.count(4), bits.bits(2)
                    bodies[index] = Body(generation, model, flags, *self.pose_by_itself(bits))
                    put.add(index)
                else:
                    bodies[index].set_flags(bits.bits(2))
            for index in sorted(bodies):
                if bodies[index].active and index not in put:
                    self.next_pose(bits, bodies[index])
            yield step, time, bodies

    def next_vertices(self, bits, soft, how):
        """How they are stored: 0 by themselves, 2 by inertia, 3 by inertia and the vertex before."""
        last, error, vertices = [0, 0, 0], [0, 0, 0], []
        for i in range(self.vertex_counts[soft.surface]):
            inert = last if how == 0 else [2 * a - b for a, b in zip(soft.now[i], soft.before[i])]
            expected = [a + b for a, b in zip(inert, error)] if how == 3 else inert
            last = [part + self.difference(bits, soft.sizes, k) for k, part in enumerate(expected)]
            error = [a - b for a, b in zip(last, inert)]
            vertices.append(last)
        soft.before, soft.now = vertices if how == 0 else soft.now, vertices

    def play_vertices(self):
        """(step, time, ropes, cloths and solids by index) of each frame."""
        softs = {}
        for is_keyframe, payload, vertices in self.frames:
            step, time, _ = struct.unpack_from("<QdQ", payload)
            old, softs, index = {} if is_keyframe else softs, {}, -1
            bits = Bits(vertices) if vertices else None
            for _ in range(bits.count(0) if bits else 0):
                index += 1 + bits.count(0)
                how = bits.bits(2)
                softs[index] = soft = Soft(bits.bits(16), bits.count(2)) if how == 0 else old[index]
                if how == 1:
                    soft.before = soft.now
                else:
                    self.next_vertices(bits, soft, how)
            yield step, time, softs

    @staticmethod
    def cell(name):
        return '"' + name.replace('"', '""') + '"' if set(name) & set(',"') else name

    def vertex_rows(self, step, time, index, soft):
        name = self.cell(self.soft_labels.get((index, soft.generation), str(index)))
        for number, vertex in enumerate(soft.now):
            numbers = ",".join(f"{math.ldexp(part, -self.position_bits):.9g}" for part in vertex)
            yield f"{step},{time:.9g},{name},{number},{numbers}"

    def row(self, step, time, index, body):
        position, quaternion = body.now
        name = self.cell(self.labels.get((index, body.generation), str(index)))
        numbers = [math.ldexp(part, -self.position_bits) for part in position]
        parts = [math.ldexp(part, -self.orientation_bits) for part in quaternion]
        largest = quaternion.index(max(quaternion))
        parts[largest] = math.sqrt(1 - sum(part * part for i, part in enumerate(parts) if i != largest))
        numbers += parts
        return f"{step},{time:.9g},{name}," + ",".join(f"{number:.9g}" for number in numbers) + f",{body.awake}"


def print_models(track):
    kinds = ["sphere", "box", "capsule", "cylinder", "cone", "plane", "geometry"]
    sizes = [4, 16, 8, 8, 8, 16, 4]
    print("model,type,shapes")
    for number, payload in enumerate(track.models):
        kind, count = struct.unpack_from("<BI", payload)
        place, shapes = 5, []
        for _ in range(count):
            shapes.append(kinds[payload[place]])
            place += 1 + sizes[payload[place]] + 28 + 3
        print(f"{number},{['fixed', 'kinematic', 'dynamic'][kind]},{' '.join(shapes)}")


def main(arguments):
    names = [a for i, a in enumerate(arguments) if not a.startswith("--") and arguments[i - 1:i] != ["--every"]]
    if len(names) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    every = int(arguments[arguments.index("--every") + 1]) if "--every" in arguments else 1
    try:
        with open(names[0], "rb") as file:
            track = Track(file.read())
        if "--bodies" in arguments:
            print_models(track)
            return 0
        if "--vertices" in arguments:
            print("step,time,soft,vertex,px,py,pz")
            for number, (step, time, softs) in enumerate(track.play_vertices()):
                if number % every == 0:
                    for index, soft in softs.items():
                        print("\n".join(track.vertex_rows(step, time, index, soft)))
            return 0
        print("step,time,body,px,py,pz,qx,qy,qz,qw,awake")
        for number, (step, time, bodies) in enumerate(track.play()):
            if number % every == 0:
                for index in sorted(bodies):
                    print(track.row(step, time, index, bodies[index]))
    except BrokenPipeError:
        raise
    except (OSError, ValueError) as error:
        print(f"recording_to_csv: {names[0]}: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except BrokenPipeError:  # who reads has seen enough
        sys.stderr.close()
