"""Ways to damage a file. Each takes the bytes, a random.Random and bytes of another file, and gives new bytes."""
import struct
import zlib

HUGE = [0, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0x8000, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000000, 0x06000000, 1 << 40, (1 << 63) - 1]
WORDS = [b"-1", b"0", b"1e308", b"-1e308", b"nan", b"inf", b"4294967295", b"99999999999999999999", b"1e-320", b"2147483648", b"{", b"}", b"[", b"((", b"0..9", b"a for a in 0..999999", b"f(x) = f(x)\n", b"\"", b"\0", b"\xff", b"="]


def flip_bits(data, random, other):
    out = bytearray(data)
    for _ in range(random.choice([1, 1, 2, 4, 16, 64])):
        at = random.randrange(len(out))
        out[at] ^= 1 << random.randrange(8)
    return bytes(out)


def set_bytes(data, random, other):
    out = bytearray(data)
    for _ in range(random.choice([1, 1, 2, 8])):
        out[random.randrange(len(out))] = random.choice([0, 1, 0x20, 0x7F, 0x80, 0xFE, 0xFF, random.randrange(256)])
    return bytes(out)


def truncate(data, random, other):
    return data[: random.randrange(len(data))]


def set_number(data, random, other):
    """A count or a length, little or big endian, of 1 to 8 bytes; mostly within the header."""
    size, order = random.choice([1, 2, 4, 4, 4, 8]), random.choice("<>")
    if len(data) <= size:
        return data
    end = len(data) - size
    at = random.randrange(min(end, 512) if random.random() < 0.7 else end)
    number = random.choice(HUGE + [random.getrandbits(8 * size), len(data), len(data) * 1000]) % (1 << (8 * size))
    return data[:at] + struct.pack(order + {1: "B", 2: "H", 4: "I", 8: "Q"}[size], number) + data[at + size :]


def set_word(data, random, other):
    """A number of a text."""
    digits = [i for i, c in enumerate(data) if 48 <= c <= 57]
    if not digits:
        return set_number(data, random, other)
    begin = random.choice(digits)
    while begin > 0 and 48 <= data[begin - 1] <= 57:
        begin -= 1
    end = begin
    while end < len(data) and 48 <= data[end] <= 57:
        end += 1
    return data[:begin] + random.choice(WORDS) + data[end:]


def repeat(data, random, other):
    begin = random.randrange(len(data))
    end = min(len(data), begin + random.choice([1, 4, 16, 64, 256, 4096]))
    return data[:end] + data[begin:end] * random.choice([1, 2, 10, 1000] if end - begin < 100 else [1, 2, 10]) + data[end:]


def remove(data, random, other):
    begin = random.randrange(len(data))
    return data[:begin] + data[begin + random.choice([1, 2, 4, 16, 64]) :]


def splice(data, random, other):
    at = random.randrange(len(data))
    begin = random.randrange(len(other))
    return data[:at] + other[begin : begin + random.choice([4, 16, 64, 1024, 1 << 20])] + data[random.choice([at, len(data)]) :]


def nest(data, random, other):
    at = random.randrange(len(data))
    opening, closing = random.choice([(b"(", b")"), (b"[", b"]"), (b"A { a: ", b" }"), (b"-", b""), (b"translate(", b")")])
    count = random.choice([10, 1000, 100000])
    return data[:at] + opening * count + b"1" + closing * random.choice([0, count]) + data[at:]


def grow(data, random, other):
    return data + random.choice([b"\0", b"\xff", b"1 ", bytes(range(256))]) * random.choice([1, 100, 10000])


def repair_png(data):
    """Right sums, so that what was damaged is looked at and not only found to be damaged."""
    out, at = data[:8], 8
    while at + 12 <= len(data):
        size = struct.unpack(">I", data[at : at + 4])[0]
        if at + 12 + size > len(data):
            break
        body = data[at + 4 : at + 8 + size]
        out += data[at : at + 4] + body + struct.pack(">I", zlib.crc32(body))
        at += 12 + size
    return out + data[at:]


BINARY = [flip_bits, flip_bits, set_bytes, set_number, set_number, set_number, truncate, repeat, remove, splice, grow]
TEXT = [flip_bits, set_bytes, set_word, set_word, set_word, truncate, repeat, remove, splice, nest, grow]


def damaged(seed, random, others):
    data = seed.data
    for _ in range(random.choice([1, 1, 1, 2, 3])):
        if not data:
            break
        kind = random.choice(TEXT if seed.text else BINARY)
        data = kind(data, random, random.choice(others).data or b"\0")
    if seed.name.endswith(".png") and random.random() < 0.7:
        data = repair_png(data)
    return data
