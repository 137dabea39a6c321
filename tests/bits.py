"""What two runs left, byte for byte: the datasets of their results, drawings, plotters' files, exit codes.

  /usr/bin/python3 tests/bits.py FOLDER FOLDER      needs numpy and h5py

Says "same", or which differ and by how much; ends with 1 where any does. Times, the scene's text and versions do not
count: they say how a result was made."""
import os, sys
import h5py, numpy as np

OTHERS = ("seconds", "scene", "versions", "inputs", "kernels")
WRITTEN = (".svg", ".gcode", ".hpgl", "codes.txt")


def datasets(path):
    found = {}
    with h5py.File(path) as f:
        def visit(name, item):
            if isinstance(item, h5py.Dataset) and name.rsplit("/", 1)[-1] not in OTHERS: found[name] = item[()]
        f.visititems(visit)
        found["status"] = f["slender"].attrs["status"]
    return found


def contents(folder):
    """By name, all that is to be the same."""
    found = {}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        if name.endswith(".vtkhdf"): found.update(datasets(path))
        if name.endswith(WRITTEN):
            with open(path, "rb") as f: found[name] = f.read()
    return found


def difference(a, b):
    """None where the bytes are the same, else a few words."""
    a, b = np.asarray(a), np.asarray(b)
    if a.shape != b.shape: return f"{list(a.shape)} and {list(b.shape)}"
    if a.dtype != b.dtype: return f"{a.dtype} and {b.dtype}"
    if a.dtype.kind not in "fiu": return None if np.array_equal(a, b) else "other words"
    if a.tobytes() == b.tobytes(): return None
    with np.errstate(all="ignore"):
        apart = np.abs(a.astype(float) - b.astype(float))
        apart = apart[np.isfinite(apart)]
        return f"by {apart.max(initial=0):.2g} of {np.nanmax(np.abs(a)):.2g}"


def main():
    a, b = contents(sys.argv[1]), contents(sys.argv[2])
    words = [f"no run: {said(folder)}" for folder in sys.argv[1:] if not has_run(folder)]
    words += [f"{name} is in one only" for name in sorted(a.keys() ^ b.keys())]
    for name in a:
        how = difference(a[name], b[name]) if name in b else None
        if how: words.append(f"{name} {how}")
    if words: print("differs: " + "; ".join(words[:6]) + (f"; and {len(words) - 6} more" if len(words) > 6 else ""))
    else: print(f"same, {len(a)} things")
    sys.exit(1 if words else 0)


def has_run(folder):
    """Whether all of its runs have computed something (exit codes 0 and 1)."""
    with open(os.path.join(folder, "codes.txt")) as f: return set(f.read().split()) <= {"0", "1"}


def said(folder):
    with open(os.path.join(folder, "said.txt")) as f: return f.readline().strip()


main()
