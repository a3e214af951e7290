#!/usr/bin/env python3
"""Fits the motion models `handheld` and `drone` to recorded paths and prints sim/motion/carrier_motion_table.inc:
  fit_motion.py DATA > sim/motion/carrier_motion_table.inc          (DATA/trajectories/{tum,euroc}_*.txt)
Also prints to stderr, for each recording, the values of the keys that go with it. Debian: python3-numpy, python3-scipy."""
import sys

import numpy as np
from scipy.optimize import least_squares

from motion_spectra import RECORDINGS, acceleration, centres, in_bands, rates, read, recordings, steps

STEP, DAMPING, CORNER = 0.01, 0.3, {"handheld": 0.07, "drone": 0.07}  # [s], [1], of the course [Hz]: sim/motion/carrier_motion.h
# Set by hand so that percentiles of speed and turn rate agree (check_motion.py): [s], [1], [Hz], [1], [m], [s].
BURST, ACTIVITY, ACTIVITY_HZ, EVENNESS, CLIMB, AHEAD = 1.0, {"handheld": 0.18, "drone": 0.33}, 0.03, {"handheld": 0.1, "drone": 3.0}, {"handheld": 0.2, "drone": 0.8}, {"handheld": 1.5, "drone": 2.0}
COMPONENTS = 0.175 * 2 ** (np.arange(13) / 2)  # [Hz]


def component(f, centre):
    """PSD of a component whose acceleration has variance 1: two equal resonators in a row."""
    u = np.concatenate((np.linspace(0.01, 4, 4000), np.geomspace(4, 100, 400)))
    shape = lambda u: (u / ((1 - u * u) ** 2 + (2 * DAMPING * u) ** 2)) ** 2 * u * u
    return shape(f / centre) / (np.trapz(shape(u), u) * centre)


def course(f, corner):
    """PSD of acceleration of a course whose rate has variance 1: a low-pass of second order."""
    return (2 * np.pi * f) ** 2 / (1 + (f / corner) ** 2) ** 2 / (np.pi * corner / 4)


def kurtosis(x):
    return ((x - x.mean(0)) ** 4).mean() / ((x - x.mean(0)) ** 2).mean() ** 2


def band_pass(increments, dt, low=0.5, high=2.0):
    F, f = np.fft.rfft(increments, axis=0), np.fft.rfftfreq(len(increments), dt)
    return np.fft.irfft(np.where(((f > low) & (f < high))[:, None], F * f[:, None], 0), axis=0)


def fit(data, kind):
    files, highest = recordings(data, kind), RECORDINGS[kind][1]
    c = centres(highest)
    f_in = np.array([np.linspace(x * 2 ** (-1 / 6), x * 2 ** (1 / 6), 9) for x in c])
    basis = np.array([component(f_in, x).mean(1) for x in COMPONENTS])  # [components, bands]
    low = course(f_in, CORNER[kind]).mean(1)
    levels, speed, turn, share, tails, fast = [], [], [], [], [], []
    for file in files:
        dt, moves, turns = steps(*read(file))
        v, w = rates(dt, moves, turns)
        speed.append(np.linalg.norm(v, axis=1).mean())
        turn.append(np.linalg.norm(w, axis=1).mean())
        both = [acceleration(x, dt) for x in (moves, turns)]
        bands = [in_bands(f, s, c) for f, s, _ in both]
        levels.append([10 * np.log10(b.sum(1)) for b in bands])
        share.append([(b / b.sum(1, keepdims=True)).mean(0) for b in bands])
        tails.append([kurtosis(band_pass(x, dt)) for x in (moves, turns)])
    levels, speed, turn, n, m = np.array(levels), np.array(speed), np.array(turn), len(files), len(COMPONENTS)
    # Amplitudes (their logarithms) of [linear, angular] x [with the motion, tremor] x component, then vehemence and tremor.
    size = 4 * m

    def model(x):
        amplitude = np.exp(2 * x[:size].reshape(2, 2, m))
        v, b = np.exp(2 * (x[size:size + n] - x[size:size + n].mean())), np.exp(2 * (x[size + n:] - x[size + n:].mean()))
        bands = np.einsum("ctm,mb->ctb", amplitude, basis)
        scale = np.stack((speed, turn), 1) ** 2
        lifted = scale * v[:, None]
        return 10 * np.log10(lifted[:, :, None] * bands[None, :, 0] + b[:, None, None] * bands[None, :, 1] + 0.3 * (scale[:, :, None] * np.array([1.0, 0.3])[None, :, None]) * low)

    def cost(x):
        residual = model(x) - levels
        amplitude = x[:size].reshape(2, 2, m)
        rough = np.diff(amplitude, 2, axis=2)  # smooth where the data say nothing
        return np.concatenate((residual.ravel(), 1.0 * rough.ravel(), 0.02 * (x + 2)))

    start = np.concatenate((np.tile(np.log([0.5, 0.05, 0.5, 0.2])[:, None], m).ravel(), np.zeros(2 * n)))
    x = least_squares(cost, start, loss="soft_l1", f_scale=2).x
    error = model(x) - levels
    amplitude = np.exp(x[:size].reshape(2, 2, m))
    v, b = np.exp(x[size:size + n] - x[size:size + n].mean()), np.exp(x[size + n:] - x[size + n:].mean())
    keys = {file.name: (speed[i], turn[i], v[i], b[i]) for i, file in enumerate(files)}
    for i, file in enumerate(files):
        print("%-45s speed %.3f m/s turn_rate %5.1f deg/s vehemence %.2f tremor %.2f  within 3 dB: %.2f %.2f" % (file.name, speed[i], np.degrees(turn[i]), v[i], b[i], *(np.abs(error[i]) < 3).mean(1)), file=sys.stderr)
    print("all within 3 dB: %.3f, kurtosis" % (np.abs(error) < 3).mean(), np.round(tails, 1).tolist(), "shares", np.round(np.mean(share, 0), 2).tolist(), file=sys.stderr)
    measured = COMPONENTS <= 1.2 * highest
    burst = np.sqrt(np.log(max(np.median(tails) / 3, 1)) / 4)  # kurtosis is 3 e^(4 s^2)
    return amplitude * measured, np.median(speed), np.median(turn), burst, keys


def keys_of(data, kind):
    """Of each recording: speed, turn_rate, vehemence, tremor."""
    return fit(data, kind)[4]


def row(values):
    return "{" + ", ".join("%.4g" % x for x in values) + "}"


if __name__ == "__main__":
    print("// Made by scenes/generate/fit_motion.py from recordings; sim/motion/carrier_motion.h has the model. Do not edit.")
    for kind, name in (("handheld", "kHandheld"), ("drone", "kDrone")):
        a, speed, turn, burst, _ = fit(sys.argv[1], kind)
        print(f"constexpr CarrierMotionTable {name} = {{\n    .speed = {speed:.3g}, .turn_rate = {turn:.3g},")
        for key, values in zip(("linear", "linear_tremor", "angular", "angular_tremor"), a.reshape(4, -1)):
            print(f"    .{key} = {row(values)},")
        print(f"    .burst = {burst:.2g}, .burst_s = {BURST}, .activity = {ACTIVITY[kind]}, .activity_hz = {ACTIVITY_HZ}, .course_hz = {CORNER[kind]},")
        print(f"    .evenness = {EVENNESS[kind]}, .climb = {CLIMB[kind]}, .ahead_s = {AHEAD[kind]}}};")
