#!/usr/bin/python3
"""Fields by hand with which the octopus's designs start, octopus_start_*.csv: one for each place, for there is no way to swim or
crawl to be found from a start that does not move by what moves in that place. Rows Bx, By, Bz in T, for each step of 2 ms
or for each knot.

    scenes/make_octopus_starts.py [FOLDER]        default: this file's own

Magnetisation points from the head to the tentacles' tips, that is towards -x: a field along -x closes the tentacles, one along +x
opens them."""
import math
import os
import sys

STEP = 2e-3


def saw(phase):
    """From 1 to -1 within the first fifth of a period, and slowly back."""
    phase %= 1
    return 1 - 10 * phase if phase < 0.2 else -1 + (phase - 0.2) / 0.4


def strokes(size, frequency):
    """Opens slowly, first from no field at all, and closes fast."""
    return lambda t: (size * saw(frequency * t + 0.6), 0, 0)


def tail(size, frequency, closing):
    """Held closed, and wagged across: what crawls where it touches the wall."""
    return lambda t: (-closing, 0, size * math.sin(2 * math.pi * frequency * t))


# Steps, and knots or None: a row for each step.
STARTS = {
    "open": (500, None, strokes(40e-3, 4)),
    "pipe1": (300, 61, tail(40e-3, 6, 30e-3)),
    "pipe2": (400, 41, strokes(40e-3, 4)),
    "tunnel": (500, 41, strokes(40e-3, 4)),
}


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    for name, (steps, knots, field) in STARTS.items():
        if knots:
            times = [steps * STEP * k / (knots - 1) for k in range(knots)]
        else:
            times = [STEP * n for n in range(1, steps + 1)]
        with open(os.path.join(folder, "octopus_start_%s.csv" % name), "w") as file:
            file.write("# A field by hand for octopus_%s.yaml, T, a row for each %s; made by make_octopus_starts.py\n"
                       % (name, "knot" if knots else "step"))
            for t in times:
                file.write("%.6g,%.6g,%.6g\n" % tuple(round(b, 9) + 0.0 for b in field(t)))


if __name__ == "__main__":
    main()
