"""Recorded camera paths: reading, third-octave bands of acceleration less the recording's noise floor, percentiles. Debian:
python3-numpy, python3-scipy."""
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

RECORDINGS = {"handheld": ("tum_*.txt", 8.0), "drone": ("euroc_*.txt", 4.0)}  # files, highest frequency [Hz]
WINDOW = 12.0  # of a periodogram [s]


def recordings(data, kind):
    return sorted((Path(data) / "trajectories").glob(RECORDINGS[kind][0]))


def read(file):
    """Times [s] from 0, positions [m], unit quaternions x y z w of one sign; of equal stamps the first."""
    rows = np.array([[float(x) for x in line.split()] for line in open(file) if line[0] != "#" and line.strip()])
    rows = rows[np.concatenate(([True], np.diff(rows[:, 0]) > 1e-4))]
    q = rows[:, 4:8] / np.linalg.norm(rows[:, 4:8], axis=1)[:, None]
    q *= np.cumprod(np.concatenate(([1], np.where((q[1:] * q[:-1]).sum(1) < 0, -1, 1))))[:, None]
    return rows[:, 0] - rows[0, 0], rows[:, 1:4], q


def steps(t, p, q, dt=None):
    """(dt, moves [n, 3], turns [n, 3] about the camera's axes) between even instants."""
    dt = dt or max(0.01, np.median(np.diff(t)))
    at = np.arange(int(t[-1] / dt)) * dt
    p, q = CubicSpline(t, p)(at), CubicSpline(t, q)(at)
    q /= np.linalg.norm(q, axis=1)[:, None]
    a, b = q[:-1], q[1:]
    vector = a[:, 3:] * b[:, :3] - b[:, 3:] * a[:, :3] - np.cross(a[:, :3], b[:, :3])
    return dt, np.diff(p, axis=0), 2 * vector


def psd(x, dt):
    """One-sided, of each column, Hann windows that overlap by half (Welch 1967)."""
    n = int(min(WINDOW, dt * len(x)) / dt)
    w = np.hanning(n)[:, None]
    s = [np.abs(np.fft.rfft((x[i:i + n] - x[i:i + n].mean(0)) * w, axis=0)) ** 2 for i in range(0, len(x) - n + 1, n // 2)]
    return np.fft.rfftfreq(n, dt)[1:], np.mean(s, 0)[1:] * 2 * dt / (w ** 2).sum()


def acceleration(increments, dt, floor=True):
    """Frequencies, PSD of the second derivative per axis, less a white noise of position or angle, and that noise's PSD summed: the
    median between 0.55 and 0.95 of the highest frequency."""
    f, s = psd(increments, dt)
    s = s / (4 * np.sin(np.pi * f * dt) ** 2)[:, None]
    top = (f > 0.275 / dt) & (f < 0.475 / dt)
    noise = np.median(s[top], axis=0) * floor
    return f, np.maximum(s - noise, 0) * (2 * np.pi * f[:, None]) ** 4, noise


def centres(highest, lowest=0.3):
    c = lowest * 2 ** (np.arange(40) / 3 + 1 / 6)
    return c[c * 2 ** (1 / 6) < 1.01 * highest]


def in_bands(f, s, c):
    """Mean of s in each third of an octave."""
    return np.array([s[(f >= x * 2 ** (-1 / 6)) & (f < x * 2 ** (1 / 6))].mean(0) for x in c])


def smooth(x, n):
    return np.stack([np.convolve(column, np.ones(n) / n, "valid") for column in x.T], 1)


def rates(dt, moves, turns):
    """Velocity and turn rate, means of 0.1 s."""
    n = max(1, round(0.1 / dt))
    return smooth(moves, n) / dt, smooth(turns, n) / dt


def percentiles(dt, moves, turns):
    """50th, 95th and 99th of speed [m/s], turn rate [rad/s] and acceleration [m/s^2], each of means over 0.1 s."""
    v, w = rates(dt, moves, turns)
    n = max(1, round(0.1 / dt))
    a = (v[n:] - v[:-n]) / (n * dt)
    return np.array([np.percentile(np.linalg.norm(x, axis=1), (50, 95, 99)) for x in (v, w, a)])
