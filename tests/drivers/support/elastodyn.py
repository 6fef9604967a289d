"""Decks of ElastoDyn, and their blades and towers as beams that only bend.

Stiffness and mass are linear between the stations of the deck's tables, the twist turns the principal axes of the
section, and the axial force is that of the rotation. The elements are cubic, fine enough for five digits of the first
frequencies. Nothing of the program is used here.
"""

import math
import pathlib
import re

import numpy
import scipy.linalg

ELEMENTS = 40
LEAST_ELEMENT = 3e-4  # of the length: a jump within it is smeared


class Deck:
    """Values of one file of OpenFAST by their names."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.lines = self.path.read_text(encoding="latin-1").splitlines()

    def word(self, *names):
        for line in self.lines:
            match = re.match(r'\s*("[^"]*"|\S+)\s+(\S+)', line)
            if match and match.group(2) in names:
                return match.group(1).strip('"')
        raise KeyError(f"{self.path}: {names}")

    def number(self, *names):
        return float(self.word(*names).lower().replace("d", "e"))

    def file(self, *names):
        return Deck(self.path.parent / self.word(*names).replace("\\", "/"))

    def table(self, first, rows):
        """Columns by name; two lines of names and units stand above the rows."""
        at = next(i for i, line in enumerate(self.lines) if line.split()[:1] == [first])
        names = self.lines[at].split()
        lines = self.lines[at + 2 : at + 2 + rows]
        values = [[float(word) for word in line.split()[: len(names)]] for line in lines]
        return dict(zip(names, numpy.array(values).T))


class BendingBeam:
    """A clamped beam of `length` [m], tables over the places 0 to 1, the root at `root` [m] from the axis."""

    def __init__(self, length, places, mass, flap, edge, twist=None, root=0.0):
        self.length, self.root, self.places = length, root, places
        self.mass, self.flap, self.edge = mass, flap, edge
        self.twist = numpy.zeros_like(places) if twist is None else numpy.radians(twist)
        nodes = numpy.unique(numpy.concatenate([places, numpy.linspace(0, 1, ELEMENTS + 1)]))
        wide = numpy.concatenate([[True], numpy.diff(nodes) > LEAST_ELEMENT])
        self.nodes = length * nodes[wide]

    def at(self, places, table):
        return numpy.interp(places / self.length, self.places, table)

    def frequencies(self, speed=0.0, count=2):
        """The lowest ones [Hz] at the rotor speed [rad/s], which turns the beam about the axis of flap."""
        size = 2 * len(self.nodes)
        stiffness, inertia = numpy.zeros((2 * size, 2 * size)), numpy.zeros((2 * size, 2 * size))
        points, weights = numpy.polynomial.legendre.leggauss(4)
        points, weights = 0.5 * (points + 1.0), 0.5 * weights
        tension = 0.0
        for i in reversed(range(len(self.nodes) - 1)):
            start, step = self.nodes[i], self.nodes[i + 1] - self.nodes[i]
            scale = numpy.array([1.0, step, 1.0, step])[:, None]
            x = points
            value = scale * [1 - 3 * x**2 + 2 * x**3, x - 2 * x**2 + x**3, 3 * x**2 - 2 * x**3,
                             x**3 - x**2]
            slope = scale / step * [6 * x**2 - 6 * x, 1 - 4 * x + 3 * x**2, 6 * x - 6 * x**2,
                                    3 * x**2 - 2 * x]
            bend = scale / step**2 * [12 * x - 6, 6 * x - 4, 6 - 12 * x, 6 * x - 2]
            places = start + step * x

            def pull(begin, end):
                inner = begin + (end - begin) * points
                load = speed**2 * self.at(inner, self.mass) * (self.root + inner)
                return (end - begin) * weights @ load

            force = numpy.array([tension + pull(place, start + step) for place in places])
            tension += pull(start, start + step)
            mass, flap, edge, twist = (self.at(places, table) for table in
                                       (self.mass, self.flap, self.edge, self.twist))

            def product(shapes, factor):
                return step * (shapes * (weights * factor)) @ shapes.T

            cos, sin = numpy.cos(twist), numpy.sin(twist)
            out = numpy.arange(2 * i, 2 * i + 4)
            across = size + out
            carried = product(slope, force)
            moved = product(value, mass)
            both = product(bend, (edge - flap) * sin * cos)
            stiffness[numpy.ix_(out, out)] += product(bend, flap * cos**2 + edge * sin**2) + carried
            stiffness[numpy.ix_(across, across)] += (
                product(bend, edge * cos**2 + flap * sin**2) + carried - speed**2 * moved)
            stiffness[numpy.ix_(out, across)] += both
            stiffness[numpy.ix_(across, out)] += both.T
            for rows in (out, across):
                inertia[numpy.ix_(rows, rows)] += moved
        free = numpy.flatnonzero(numpy.arange(2 * size) % size > 1)
        squares = scipy.linalg.eigh(stiffness[numpy.ix_(free, free)], inertia[numpy.ix_(free, free)],
                                    eigvals_only=True, subset_by_index=[0, count - 1])
        return numpy.sqrt(squares) / (2 * math.pi)


def blade(main):
    """The first blade of an ElastoDyn file."""
    deck = main.file("BldFile1", "BldFile(1)")
    table = deck.table("BlFract", int(deck.number("NBlInpSt")))
    return BendingBeam(main.number("TipRad") - main.number("HubRad"), table["BlFract"],
                       table["BMassDen"] * deck.number("AdjBlMs"),
                       table["FlpStff"] * deck.number("AdjFlSt"),
                       table["EdgStff"] * deck.number("AdjEdSt"), table["StrcTwst"],
                       main.number("HubRad"))


def tower(main):
    """The tower of an ElastoDyn file."""
    deck = main.file("TwrFile")
    table = deck.table("HtFract", int(deck.number("NTwInpSt", "NTwInptSt")))
    return BendingBeam(main.number("TowerHt") - main.number("TowerBsHt"), table["HtFract"],
                       table["TMassDen"] * deck.number("AdjTwMa"),
                       table["TwFAStif"] * deck.number("AdjFASt"),
                       table["TwSSStif"] * deck.number("AdjSSSt"))
