#!/usr/bin/env python3
"""How far off are the matches of an odometry, and does it know? They are held against the exact depth and motion of a rendered scene.

    PYTHONPATH=build/release/tools/python python3 tools/python/examples/match_errors.py [SCENARIO [KEY=VALUE ...]]

A landmark is what the pixel of its first view shows. For each amount of blur and of noise there are two rows: landmarks on surfaces, and
those whose patch of 9 x 9 pixels spans more than 5 % of their depth. Where these move with what is before them is not known from the pixel
alone, so they are given the depth that fits all their matches best: what is left is no point that stands still. Needs numpy.
"""
import pathlib
import sys

import numpy as np

import vobench

MATCHED, MISSED, REJECTED, NEW = range(4)
MEDIAN, IN_95, IN_999 = 1.386, 5.991, 13.816  # of chi-square with two degrees of freedom
FIRST_VIEW_PX = 0.2                           # what the filter believes of it (odometry.features.sigma_floor)


class Landmark:
    """Its first view, and every match of it with the truth of that frame."""

    def __init__(self, T_WC, ray, patch):
        self.T_WC, self.ray, self.depth = T_WC, ray, patch[4, 4]
        self.near, self.far = patch.min(), patch.max()
        self.poses, self.pixels, self.covariances, self.used = [], [], [], []

    def at_an_edge(self):
        return self.far - self.near > 0.05 * self.depth

    def errors(self, camera):
        """Matched less true pixel, at the truth's depth or, at an edge, at the one that fits best."""
        T, pixels, used = np.array(self.poses), np.array(self.pixels), np.array(self.used)

        def at(depth):
            X_W = self.T_WC[:3, :3] @ (self.ray * depth) + self.T_WC[:3, 3]
            return pixels - camera.project(np.einsum("nji,nj->ni", T[:, :3, :3], X_W - T[:, :3, 3]))

        if not self.at_an_edge():
            return at(self.depth)
        depths = 1 / np.linspace(0.9 / self.far, 1.1 / self.near, 60)
        return min((at(depth) for depth in depths), key=lambda e: (e[used] ** 2).sum())


def landmarks_of(scenario, seed=1):
    """All landmarks of a run of the default odometry that were matched ten times or more."""
    simulator = vobench.Simulator(scenario)
    odometry = vobench.Odometry.of(simulator, "rb2pf", seed)
    camera, landmarks = simulator.camera, {}
    for frame in simulator:
        odometry.track(frame)
        ids, status, _, pixels, _, R = odometry.features()
        for i in np.flatnonzero((status == MATCHED) | (status == REJECTED)):
            if ids[i] in landmarks:
                seen = landmarks[ids[i]]
                seen.poses.append(frame.truth.T_WC)
                seen.pixels.append(pixels[i])
                seen.covariances.append(R[i])
                seen.used.append(status[i] == MATCHED)
        new = np.flatnonzero(status == NEW)
        if len(new):
            depth = simulator.depth(frame.index)
            for i, ray in zip(new, camera.undistort(pixels[new])):
                u, v = pixels[i].astype(int)
                landmarks[ids[i]] = Landmark(frame.truth.T_WC, np.append(ray, 1), depth[v - 4:v + 5, u - 4:u + 5])
    return [m for m in landmarks.values() if sum(m.used) >= 10], camera


def robust_sigma(errors):
    return 1.4826 * np.median(np.abs(errors))


def row(landmarks, camera):
    errors = [m.errors(camera) for m in landmarks]
    used = [np.array(m.used) for m in landmarks]
    e = np.concatenate([x[u] for x, u in zip(errors, used)])
    R = np.concatenate([np.array(m.covariances)[u] for m, u in zip(landmarks, used)]) + FIRST_VIEW_PX**2 * np.eye(2)
    mean = np.array([x[u].mean(axis=0) for x, u in zip(errors, used)])
    since = np.concatenate([x[u] - x[u].mean(axis=0) for x, u in zip(errors, used)])
    size, squared = np.linalg.norm(e, axis=1), np.einsum("ni,nij,nj->n", e, np.linalg.inv(R), e)
    return (f"{len(e):7d} {100 * np.concatenate(used).mean():6.1f} {robust_sigma(e):7.3f} {np.sqrt((e**2).mean()):6.3f} {robust_sigma(mean):7.3f} "
            f"{robust_sigma(since):7.3f} {100 * (size > 0.3).mean():7.1f} {100 * (size > 1).mean():6.2f} "
            f"{np.sqrt(np.median(np.trace(R, axis1=1, axis2=2) / 2)):9.3f} {np.median(squared) / MEDIAN:7.2f} {100 * (squared < IN_95).mean():7.1f} "
            f"{100 * (squared < IN_999).mean():7.1f}")


def main():
    scenes = pathlib.Path(__file__).parents[3] / "scenes"
    file = sys.argv[1] if len(sys.argv) > 1 else scenes / "room.yaml"
    given = dict(argument.split("=", 1) for argument in sys.argv[2:])
    cases = [(f"exposure {ms} ms", {"sensor.exposure": f"{ms} ms"}) for ms in (0, 8, 16, 32)]
    cases += [(f"read noise {n} e", {"sensor.exposure": "0 ms", "sensor.read_noise": f"{n} e"}) for n in (50, 100, 200)]
    print("                           matches used % sigma px    rms  first   since > 0.3 px % > 1 %  believed  median in 95 % in 99.9 %")
    for name, changes in cases:
        landmarks, camera = landmarks_of(vobench.Scenario(file, {**changes, **given}))
        for where, edge in ("on surfaces", False), ("at edges", True):
            own = [m for m in landmarks if m.at_an_edge() == edge]
            print(f"{name:15} {where:11}", row(own, camera) if own else "      0", flush=True)


if __name__ == "__main__":
    main()
