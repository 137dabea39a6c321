#!/usr/bin/python3
"""Makes the banner: designs its letters one by one (banner_letter.yaml), and assembles what it found for
banner.yaml: banner_magnetization.csv, banner_young.csv, banner_fold.csv.

    scenes/make_banner.py [PROGRAM [WORD]]        build/slender, SLENDER

Each letter takes about twenty seconds; those that are done already, in build/banner, are taken as they are. For
another word give banner.yaml a sheet of as many letters, and the pinned points, both told at the end."""
import os
import subprocess
import sys

SCENES = os.path.dirname(os.path.abspath(__file__))
WORK = os.path.join(SCENES, "..", "build", "banner")
COLUMNS, ROWS = 32, 40  # cells of banner_letter.yaml

# Strokes on a grid of 4 by 6, from the lower left; points of a polyline.
GLYPHS = {
    "A": ["00 26 40", "12 32"],
    "B": ["00 06 36 45 44 33 03", "33 42 41 30 00"],
    "D": ["00 06 26 44 42 20 00"],
    "E": ["46 06 00 40", "03 33"],
    "H": ["00 06", "40 46", "03 43"],
    "I": ["20 26"],
    "L": ["06 00 40"],
    "M": ["00 06 23 46 40"],
    "N": ["00 06 40 46"],
    "O": ["10 30 41 45 36 16 05 01 10"],
    "R": ["00 06 36 45 44 33 03", "23 40"],
    "S": ["45 36 16 05 04 13 33 42 41 30 10 01"],
    "T": ["06 46", "20 26"],
}


def segments(letter):
    """x0, y0, x1, y1 in m, on the sheet of 52 by 65 mm."""
    rows = []
    for line in GLYPHS[letter]:
        points = [(0.013 + 0.0065 * int(p[0]), 0.012 + 0.041 / 6 * int(p[1])) for p in line.split()]
        rows += [a + b for a, b in zip(points, points[1:])]
    return rows


def run(*arguments):
    subprocess.run(arguments, check=True, cwd=WORK)


def design(program, letter):
    """The letter's design, by banner_letter.yaml: its result file."""
    result = os.path.join(WORK, letter + ".vtkhdf")
    if not os.path.exists(result):
        strokes = ", ".join("[%s]" % ", ".join("%.6g" % x for x in row) for row in segments(letter))
        run(program, "run", os.path.join(SCENES, "banner_letter.yaml"), "--set", "target.strokes=[%s]" % strokes,
            "-o", letter, "--force")
    return result


def table(program, result, dataset):
    run(program, "export", result, "-o", "table.csv", "--dataset", dataset)
    with open(os.path.join(WORK, "table.csv")) as file:
        return [[float(x) for x in line.split(",")] for line in file if line[0] in "-0123456789"]


def write(name, comment, rows):
    with open(os.path.join(SCENES, name), "w") as file:
        file.write("# %s\n" % comment)
        file.writelines(row + "\n" for row in rows)


def main():
    program = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(SCENES, "..", "build", "slender"))
    word = sys.argv[2] if len(sys.argv) > 2 else "SLENDER"
    os.makedirs(WORK, exist_ok=True)
    across = COLUMNS * len(word) + 1  # vertices of a row of the banner
    count = len(word)
    faces = {name: [None] * (2 * ROWS * COLUMNS * count) for name in ("magnetization", "young")}
    fold = {}
    for k, letter in enumerate(word):
        result = design(program, letter)
        for name, rows in faces.items():
            for f, row in enumerate(table(program, result, "design/" + name)):
                cell, side = divmod(f, 2)
                at = (cell // COLUMNS) * COLUMNS * count + k * COLUMNS + cell % COLUMNS
                rows[2 * at + side] = row
        place = lambda v: int(v) // (COLUMNS + 1) * across + k * COLUMNS + int(v) % (COLUMNS + 1)
        for edge, (factor,) in zip(table(program, result, "edges"), table(program, result, "design/fold")):
            fold[place(edge[0]), place(edge[1])] = factor
    write("banner_magnetization.csv", "Remanent magnetisation of banner.yaml, A/m, a row per face",
          (",".join("%.4g" % x for x in row) for row in faces["magnetization"]))
    write("banner_young.csv", "Young's modulus of banner.yaml, Pa, a row per face",
          ("%.3g" % row[0] for row in faces["young"]))
    write("banner_fold.csv", "Factors on the folds of banner.yaml: vertices of an edge, factor; 1 elsewhere",
          ("%d,%d,%.3g" % (a, b, x) for (a, b), x in sorted(fold.items()) if abs(x - 1) > 0.02))
    pinned = [j * ROWS // 2 * across + i * COLUMNS // 2
              for j in range(3) for i in range(2 * count + 1) if j != 1 or i % 2 == 0]
    print("sheet: size: [%d mm, 65 mm], cells: [%d, %d]; pinned:" % (52 * count, COLUMNS * count, ROWS))
    print(pinned)


if __name__ == "__main__":
    main()
