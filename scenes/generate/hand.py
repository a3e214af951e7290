"""Hand-held paths: a smooth course, a tremor over it, both scaled to the mean speeds that are wanted.

Angles are yaw (0 looks to -z, a quarter turn right to +x), pitch (up) and roll about the optical axis [rad]; y is up."""
import numpy as np

STEP = 1.0 / 240.0  # of the integration [s]


def through(times, values):
    """A natural cubic spline through values [n, d] at times, as a function of time."""
    t, y = np.array(times, float), np.array(values, float)
    h = np.diff(t)
    a = np.eye(len(t))
    b = np.zeros_like(y)
    for i in range(1, len(t) - 1):
        a[i, i - 1:i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
        b[i] = 6 * ((y[i + 1] - y[i]) / h[i] - (y[i] - y[i - 1]) / h[i - 1])
    m = np.linalg.solve(a, b)

    def at(s):
        i = np.clip(np.searchsorted(t, s, side="right") - 1, 0, len(t) - 2)
        u, v, w = (s - t[i])[:, None], (t[i + 1] - s)[:, None], h[i][:, None]
        return (m[i] * v ** 3 + m[i + 1] * u ** 3) / (6 * w) + (y[i] / w - m[i] * w / 6) * v + (y[i + 1] / w - m[i + 1] * w / 6) * u

    return at


def tremor(rng, sigma, low=0.35, high=1.5, waves=9):
    """Random swings in three numbers, of standard deviation `sigma` each, between `low` and `high` Hz, the slow ones larger."""
    frequency, phase = rng.uniform(low, high, (waves, 3)), rng.uniform(0, 2 * np.pi, (waves, 3))
    size = 1 / frequency
    size *= np.asarray(sigma) / np.sqrt((size ** 2).sum(0) / 2)
    return lambda s: (size * np.sin(2 * np.pi * frequency * s[:, None, None] + phase)).sum(1)


def rotations(angles):
    """R_WC [n, 3, 3]: camera x right, y down, z forward."""
    yaw, pitch, roll = angles.T
    forward = np.stack((np.sin(yaw) * np.cos(pitch), np.sin(pitch), -np.cos(yaw) * np.cos(pitch)), -1)
    right = np.stack((np.cos(yaw), 0 * yaw, np.sin(yaw)), -1)
    down = np.cross(forward, right)
    c, s = np.cos(roll)[:, None], np.sin(roll)[:, None]
    return np.stack((c * right + s * down, c * down - s * right, forward), -1)


def quaternions(matrices):
    """x y z w, with w >= 0."""
    out = []
    for m in matrices:
        k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0], [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
                      [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], 0],
                      [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)]])
        q = np.linalg.eigh(k / 3)[1][:, -1]  # Bar-Itzhack 2000
        out.append(q if q[3] >= 0 else -q)
    return np.array(out)


def mean_speeds(position, matrices, dt):
    linear = np.linalg.norm(np.diff(position, axis=0), axis=1).mean() / dt
    cosine = (np.einsum("nij,nij->n", matrices[:-1], matrices[1:]) - 1) / 2
    return linear, np.arccos(np.clip(cosine, -1, 1)).mean() / dt


def held(course, rng, duration, speed, turn_rate, shake=0.004, sway=(0.010, 0.010, 0.008), key_step=0.2):
    """Keys (time, position, x y z w) of course(t) -> (positions, angles) with a tremor, flown at the mean speeds [m/s, rad/s]:
    positions are scaled about their middle, angles about theirs. Returns the keys and the two factors."""
    wobble, swing = tremor(rng, shake), tremor(rng, sway)
    t = np.arange(0, duration + STEP / 2, STEP)
    places, angles = course(t)
    places, angles = places + wobble(t), angles + swing(t)
    middle, rest = places.mean(0), angles.mean(0)
    linear = mean_speeds(places, rotations(angles), STEP)[0]
    p, q = speed / linear, 1.0
    for _ in range(30):
        q *= turn_rate / mean_speeds(places, rotations(rest + q * (angles - rest)), STEP)[1]
    keys = np.arange(0, duration + key_step / 2, key_step)
    at = np.minimum(np.round(keys / STEP).astype(int), len(t) - 1)
    return keys, middle + p * (places[at] - middle), quaternions(rotations(rest + q * (angles[at] - rest))), (p, q)
