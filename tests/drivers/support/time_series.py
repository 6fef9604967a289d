"""Reads the time series that the program writes, with readers of their own."""

import struct

import h5py
import numpy


def read_rows(path):
    """Times and values of a result."""
    with h5py.File(path, "r") as file:
        return file["transient/time"][:], file["transient/values"][:]


def read_csv(path):
    """Names, units and rows of a .csv; the first column is the time."""
    lines = path.read_text(encoding="utf-8").splitlines()
    heads = [word.rstrip("]").split(" [") for word in lines[0].split(",")]
    rows = numpy.array([[float(word) for word in line.split(",")] for line in lines[1:]])
    return [name for name, _ in heads], [unit for _, unit in heads], rows


def read_out(path):
    """The same of OpenFAST's text output, by its fixed lines: names in line 7, units in line 8."""
    lines = path.read_text(encoding="ascii").splitlines()
    # Other readers look for the first line that begins with Time.
    first = next(i for i, line in enumerate(lines) if (line + " -").lower().split()[0] == "time")
    assert first == 6, "names are not in line 7"
    names, units = lines[6].split("\t"), lines[7].split("\t")
    rows = numpy.array([[float(word) for word in line.split("\t")] for line in lines[8:]])
    return names, units, rows


def read_outb(path):
    """The same of OpenFAST's binary output of kind 4: 16 bits a value, in equal steps of time."""
    content = path.read_bytes()
    kind, width, channels, count, start, step = struct.unpack_from("<hhiidd", content)
    assert kind == 4
    place = struct.calcsize("<hhii") + 16
    scales = numpy.frombuffer(content, "<f4", channels, place)
    offsets = numpy.frombuffer(content, "<f4", channels, place + 4 * channels)
    place += 8 * channels
    length, = struct.unpack_from("<i", content, place)
    place += 4 + length
    words = []
    for _ in range(2 * (channels + 1)):
        words.append(content[place:place + width].decode("ascii").strip())
        place += width
    packed = numpy.frombuffer(content, "<i2", offset=place).reshape(count, channels)
    values = (packed - offsets.astype(float)) / scales.astype(float)
    times = start + step * numpy.arange(count)
    rows = numpy.column_stack([times, values])
    return words[:channels + 1], words[channels + 1:], rows
