#!/usr/bin/python3
"""Makes still_life.png, and still_life.jpg in colours: a vase, a lemon, spheres and a cloth on a table before a curtain, lit from the left.

Distances to the bodies are followed along rays [sphere tracing, Hart 1996], with a soft shadow from a lamp of some
size, ambient occlusion and a little grain. Needs numpy and PIL; takes about ten seconds."""
import numpy as np
from PIL import Image

WIDTH, HEIGHT = 600, 450


def norm(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def smooth_min(a, b, k):
    h = np.clip(0.5 + 0.5 * (b - a) / k, 0, 1)
    return b + (a - b) * h - k * h * (1 - h)


def sphere(p, center, radius):
    return np.linalg.norm(p - center, axis=-1) - radius


def ellipsoid(p, center, radii):
    q = (p - center) / radii
    length = np.linalg.norm(q, axis=-1)
    return length * (length - 1) / np.maximum(np.linalg.norm(q / radii, axis=-1), 1e-9)


# The vase's radius over its height: corners of an interpolation, rounded.
LEVELS = np.linspace(-0.4, 2.4, 561)
RADII = np.interp(LEVELS, [0, 0.1, 0.35, 0.75, 1.15, 1.45, 1.65, 1.8, 1.95], [0.28, 0.36, 0.56, 0.7, 0.5, 0.25, 0.18, 0.2, 0.34])
KERNEL = np.exp(-0.5 * (np.arange(-60, 61) / 22) ** 2)
RADII = np.convolve(np.pad(RADII, 60, 'edge'), KERNEL / KERNEL.sum(), 'valid')


def vase(p):
    x, y, z = p[..., 0] + 0.95, p[..., 1], p[..., 2] - 0.55
    r = np.hypot(x, z)
    profile = np.interp(y, LEVELS, RADII)
    body = (r - profile) * 0.6
    return np.maximum(np.maximum(body, -y), y - 1.95)


def curtain(p):
    x, y, z = p[..., 0], p[..., 1], p[..., 2]
    sway = x + 0.12 * np.sin(1.3 * y) + 0.1 * y
    folds = 0.16 * np.sin(3.1 * sway) + 0.07 * np.sin(7.3 * sway + 1) * np.sin(0.7 * y + x)
    return (2.1 + folds - z) * 0.6


def cloth(p):
    x, y, z = p[..., 0] - 0.9, p[..., 1], p[..., 2] + 0.25
    wave = 0.035 * np.sin(5 * x + 2 * z) + 0.025 * np.sin(7 * z - 3 * x) + 0.03
    edge = np.maximum(np.abs(0.9 * x + 0.35 * z) - 1.0, np.abs(0.9 * z - 0.35 * x) - 0.62)
    return smooth_min(y, np.maximum((y - wave) * 0.7, 0.7 * edge), 0.03)


TINTS = [  # of the bodies below: red, green, blue
    [1.0, 0.72, 0.5], [0.95, 0.45, 0.4], [0.45, 0.75, 1.05], [1.05, 1.0, 0.9], [0.75, 1.1, 0.4], [1.1, 0.6, 0.25], [1.12, 1.02, 0.25], [0.9, 0.3, 0.75],
]
BODIES = [  # distance, brightness, gloss
    (lambda p: p[..., 1], 0.55, 0.05),
    (curtain, 0.34, 0.0),
    (vase, 0.62, 0.55),
    (cloth, 0.93, 0.0),
    (lambda p: sphere(p, [0.35, 0.47, 0.35], 0.42), 0.45, 0.35),
    (lambda p: sphere(p, [1.35, 0.36, 0.15], 0.29), 0.8, 0.25),
    (lambda p: ellipsoid(p, np.array([-0.15, 0.22, -0.55]), np.array([0.31, 0.22, 0.22])), 0.85, 0.15),
    (lambda p: sphere(p, [0.72, 0.24, -0.55], 0.2), 0.25, 0.5),
]


def distances(p):
    return np.stack([body[0](p) for body in BODIES])


def distance(p):
    return distances(p).min(0)


def march(origin, direction, reach, steps):
    t = np.full(direction.shape[:-1], 0.02)
    for _ in range(steps):
        d = distance(origin + t[..., None] * direction)
        t = np.minimum(t + d, reach)
    return t


def shadow(origin, direction, reach, hardness):
    t, light = np.full(direction.shape[:-1], 0.03), np.ones(direction.shape[:-1])
    for _ in range(48):
        d = distance(origin + t[..., None] * direction)
        light = np.minimum(light, np.clip(0.5 + 0.5 * hardness * d / t, 0, 1))
        t = np.minimum(t + np.clip(d, 0.02, 0.2), reach)
    return light * light * (3 - 2 * light)


def main():
    u, v = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH * 2 - 1, 1 - (np.arange(HEIGHT) + 0.5) / HEIGHT * 2)
    eye, look = np.array([0.15, 1.75, -5.2]), np.array([0.15, 0.78, 0.3])
    ahead = norm(look - eye)
    right = norm(np.cross([0, 1, 0], ahead))
    up = np.cross(ahead, right)
    ray = norm(2.6 * ahead + u[..., None] * right + v[..., None] * up * HEIGHT / WIDTH)
    p = eye + march(eye, ray, 12, 110)[..., None] * ray
    e = 1e-3 * np.eye(3)
    normal = norm(np.stack([distance(p + e[k]) - distance(p - e[k]) for k in range(3)], -1))
    which = distances(p).argmin(0)
    base, gloss = np.array([b[1] for b in BODIES])[which], np.array([b[2] for b in BODIES])[which]
    grain = 1 + 0.1 * np.sin(60 * p[..., 2] + 6 * np.sin(3 * p[..., 0]) + 4 * np.sin(1.7 * p[..., 2]))
    base = np.where(which == 0, base * grain, base)
    stripe = 1 - 0.45 * ((np.abs(p[..., 1] - 0.78) < 0.06) | (np.abs(p[..., 1] - 1.05) < 0.025))
    base = np.where(which == 2, base * stripe, base)

    lamp = np.array([-3.2, 4.2, -3.0])
    to_lamp = lamp - p
    reach = np.linalg.norm(to_lamp, axis=-1)
    to_lamp = to_lamp / reach[..., None]
    facing = np.clip((normal * to_lamp).sum(-1), 0, 1)
    lit = facing * shadow(p + 4e-3 * normal, to_lamp, reach, 9) * (5.8 / reach) ** 2
    ambient = np.ones(lit.shape)
    for k in range(1, 6):
        ambient -= 0.55 ** k * np.clip(0.09 * k - distance(p + 0.09 * k * normal), 0, 1) / 0.09
    half = norm(to_lamp - ray)
    shine = gloss * np.clip((normal * half).sum(-1), 0, 1) ** 60 * (lit > 0.05)
    matt = base * (0.95 * lit + 0.16 * np.clip(ambient, 0.1, 1))
    grain = np.random.default_rng(1).normal(0, 0.006, matt.shape)

    def bytes_of(light, grain):
        level = np.clip(light / (0.35 + light) * 1.2, 0, 1) ** 0.9 + grain
        return Image.fromarray((255 * np.clip(level, 0, 1)).round().astype(np.uint8))

    bytes_of(matt + shine, grain).save('still_life.png', optimize=True)
    bytes_of(matt[..., None] * np.array(TINTS)[which] + shine[..., None], grain[..., None]).save('still_life.jpg', quality=90)


main()
