"""Decodes a weight blob and runs its self-test, from docs/weight-blob.md alone.

Usage: python3 decode_blob.py BLOB. Needs nothing but Python 3. Exit code 1 and one
sentence if the blob is refused or its self-test disagrees.
"""

import struct
import sys

RECURRENCES = ["feedforward", "self", "elman"]
TANHS = ["rational", "libm", "micromath"]
LAWS = ["linear", "saturating"]
TYPE_CODES = ["any", "nearest", "share", "nearest-wall-any-target", "bearing"]
WEIGHT_LIMIT = 1.0e6


def refuse(reason):
    sys.exit(f"refused: {reason}")


def f32(value):
    """Rounds a double to f32.

    The double holds a sum, difference, product or quotient of two f32 rounded once; it has
    more than twice the bits of f32 plus two, so rounding it again gives what f32 hardware gives.
    """
    return struct.unpack("<f", struct.pack("<f", value))[0]


def bits(value):
    return struct.unpack("<I", struct.pack("<f", value))[0]


def crc64(data):
    """CRC-64/XZ: reflected, generator 42f0e1eba9ea3693, all ones in, all ones out."""
    crc = (1 << 64) - 1
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xC96C5795D7870F42 if crc & 1 else 0)
    return crc ^ (1 << 64) - 1


def rational_tanh(x):
    limit = f32(8.089648)
    x = limit if x > limit else x
    x = -limit if x < -limit else x
    u = f32(x * x)

    def polynomial(coefficients):
        value = f32(coefficients[0])
        for coefficient in coefficients[1:]:
            value = f32(f32(value * u) + f32(coefficient))
        return value

    numerator = polynomial([1.3842885e-8, 2.0951664e-5, 0.003516053, 0.13398157, 1.0])
    denominator = polynomial([7.97338e-7, 0.0003319338, 0.025954522, 0.46731475, 1.0])
    return f32(f32(x * numerator) / denominator)


class Header:
    def __init__(self, data):
        (self.inputs, self.hidden, self.outputs, recurrence, biases, tanh, order, beams,
         law, types, self.triples, padding) = struct.unpack_from("<12B", data, 16)
        if struct.unpack_from("<H", data, 10)[0] != 176:
            refuse("header length")
        if self.inputs != 7 or beams != 5 or order != 1:
            refuse("inputs, beams or summation order")
        if self.hidden < 1 or not 1 <= self.outputs <= 2 or biases > 1:
            refuse("layer widths or biases")
        if padding or struct.unpack_from("<H", data, 142)[0]:
            refuse("padding")
        if recurrence > 2 or tanh > 2 or law > 1 or types > 4:
            refuse("unknown code")
        self.recurrence, self.tanh = RECURRENCES[recurrence], TANHS[tanh]
        self.law, self.types, self.biases = LAWS[law], TYPE_CODES[types], biases == 1
        numbers = struct.unpack_from("<22f", data, 28)
        if any(number != number or abs(number) == float("inf") for number in numbers):
            refuse("a number in the header is not finite")
        (self.half, self.range, self.steer_limit, self.step_lower, self.step_upper,
         self.period, self.wheelbase) = numbers[:7]
        self.beams = [numbers[7 + 3 * i:10 + 3 * i] for i in range(5)]
        pi = f32(3.14159265358979)
        if (bits(self.half) if law == 0 else self.half <= 0):
            refuse("half distance")
        if not (self.range > 0 and 0 < self.steer_limit <= f32(pi / 2)
                and 0 <= self.step_lower <= self.step_upper and self.step_upper > 0
                and self.period > 0 and self.wheelbase > 0
                and all(abs(angle) <= pi for _, _, angle in self.beams)):
            refuse("a number in the header is out of its range")
        self.generation, self.seed = struct.unpack_from("<IQ", data, 116)
        self.scenario_hash = data[128:136].hex()
        self.tool = struct.unpack_from("<3H", data, 136)
        name = data[144:176]
        text = name.split(b"\0")[0]
        if name != text.ljust(32, b"\0"):
            refuse("scenario name")
        try:
            self.scenario = text.decode()
        except UnicodeDecodeError:
            refuse("scenario name")

    def weights(self):
        i, h, o = self.inputs, self.hidden, self.outputs
        memory = {"feedforward": 0, "self": h, "elman": h * h}[self.recurrence]
        return i * h + h * h + h * o + 2 * memory + (2 * h + o if self.biases else 0)

    def triple(self):
        return self.inputs + 2 * self.hidden + self.outputs


def decode(data):
    if len(data) < 16:
        refuse("too short")
    if data[:8] != b"EVOSTEER":
        refuse("magic")
    version, _, length = struct.unpack_from("<HHI", data, 8)
    if version != 1:
        refuse(f"version {version}")
    if len(data) != length or length < 184:
        refuse(f"{len(data)} bytes, {length} stated")
    if crc64(data[:-8]) != struct.unpack_from("<Q", data, length - 8)[0]:
        refuse("check")
    header = Header(data)
    count = header.weights()
    words = count + header.triples * header.triple()
    if length != 176 + 4 * words + 8:
        refuse("length against topology")
    numbers = list(struct.unpack_from(f"<{words}f", data, 176))
    weights, triples = numbers[:count], numbers[count:]
    if not all(abs(weight) <= WEIGHT_LIMIT for weight in weights):
        refuse("weight")
    if not all(abs(word) <= 1 for word in triples):
        refuse("self-test word")
    return header, weights, triples


def step(header, weights, inputs, first, second):
    """One step of the network; every operation rounded to f32."""
    genome = iter(weights)

    def take(count):
        return [next(genome) for _ in range(count)]

    def layer(values, width, previous=None):
        matrix = [take(width) for _ in values]
        memory = []
        if previous is not None and header.recurrence == "self":
            own = take(width)
            memory = [[own[j] if j == i else None for j in range(width)] for i in range(width)]
        elif previous is not None and header.recurrence == "elman":
            memory = [take(width) for _ in range(width)]
        sums = take(width) if header.biases else [0.0] * width
        rows = list(zip(matrix, values)) + list(zip(memory, previous or []))
        for row, value in rows:
            for j, weight in enumerate(row):
                if weight is not None:
                    sums[j] = f32(sums[j] + f32(weight * value))
        return [rational_tanh(total) for total in sums]

    first = layer(inputs, header.hidden, first)
    second = layer(first, header.hidden, second)
    return layer(second, header.outputs)


def self_test(header, weights, triples):
    if header.tanh != "rational":
        return "not run, this script knows the rational tanh only"
    size = header.triple()
    for start in range(0, len(triples), size):
        words = triples[start:start + size]
        cuts = [header.inputs, header.inputs + header.hidden, header.inputs + 2 * header.hidden]
        inputs, first = words[:cuts[0]], words[cuts[0]:cuts[1]]
        second, expected = words[cuts[1]:cuts[2]], words[cuts[2]:]
        found = step(header, weights, inputs, first, second)
        if [bits(x) for x in found] != [bits(x) for x in expected]:
            sys.exit(f"self-test {start // size}: {found} computed, {expected} recorded")
    return f"{header.triples} of {header.triples} triples agree bit for bit"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: decode_blob.py BLOB")
    with open(sys.argv[1], "rb") as file:
        header, weights, triples = decode(file.read())
    sizes = f"{header.inputs}-{header.hidden}-{header.hidden}-{header.outputs}"
    biases = "biases" if header.biases else "no biases"
    # Nine digits name an f32; the shortest that do are what people wrote.
    shortest = next(s for s in (f"{header.steer_limit:.{n}g}" for n in range(1, 10))
                    if f32(float(s)) == header.steer_limit)
    print(f"topology: {sizes} {header.recurrence}, {biases}")
    print(f"tanh: {header.tanh}")
    print(f"encoding: {header.law}, {header.types}")
    print(f"range: {header.range}")
    print(f"steer limit: {shortest}")
    print(f"scenario: {header.scenario}")
    print(f"seed: {header.seed}")
    print("weights:", " ".join(f"{bits(weight):08x}" for weight in weights))
    print(f"self-test: {self_test(header, weights, triples)}")


main()
