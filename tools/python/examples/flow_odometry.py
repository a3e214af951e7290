#!/usr/bin/env python3
"""Monocular odometry in the plainest way: optical flow, five-point start, PnP, triangulation at key frames.

    flow_odometry.py SEQUENCE TRAJECTORY

SEQUENCE: rgb.txt, its images, and camera.yaml (`vobench render`, or a recorded sequence with `--camera FILE`).
TRAJECTORY: of each frame that has a pose, in TUM's format, T_WC; the scale is that of the start. Needs python3-opencv;
with python3-scipy the last key frames are adjusted (Triggs et al. 2000). Sources: Shi & Tomasi 1994; Lucas & Kanade
1981, Bouguet 2001 (pyramid); Nister 2004; Hartley & Zisserman 2004, section 12.2; all but the adjustment by OpenCV.
"""
import argparse
import os
import re

import cv2
import numpy as np

try:
    from scipy.optimize import least_squares
    from scipy.sparse import lil_matrix
except ImportError:
    least_squares = None

CORNERS = 400
LEAST_DISTANCE_PX = 12
START_PARALLAX_PX = 20  # median flow, at 640 pixels of width
KEYFRAME_PARALLAX_PX = 25
KEYFRAME_SHARE = 0.7  # of the landmarks of the last key frame that are still tracked
LEAST_ANGLE = np.radians(1.0)  # between the rays of a triangulation
LEAST_INLIERS = 12
REPROJECTION_PX = 3.0
WINDOW = 6  # key frames that are adjusted
WIDEST = 1.3  # of a fisheye's rays, from the axis [rad]: the program computes on the plane z = 1


def read_camera(file):
    """K, the distortion coefficients in OpenCV's order, and whether they are those of a fisheye lens."""
    text = open(file).read()
    if "camera_matrix" in text:  # OpenCV's own
        K, lens = (np.array(data.split(","), float) for data in re.findall(r"data\s*:\s*\[([^]]*)", text)[:2])
        return K.reshape(3, 3), lens, False

    def number(key, default=None):
        match = re.search(rf"\b{key}\s*:\s*([-+0-9.eE]+)", text)
        if match is None and default is None:
            raise SystemExit(f"{file}: there is no {key}")
        return float(match[1]) if match else default

    fisheye = bool(re.search(r"model\s*:\s*[\"']?fisheye", text))
    K = np.array([[number("fx"), 0, number("cx")], [0, number("fy"), number("cy")], [0, 0, 1]])
    coefficients = ("k1", "k2", "k3", "k4") if fisheye else ("k1", "k2", "p1", "p2", "k3")
    return K, np.array([number(k, 0.0) for k in coefficients]), fisheye


class Track:
    """A corner that is followed: its ray (X/Z, Y/Z) in each key frame, and its point once it is triangulated."""

    def __init__(self, pixel):
        self.pixel = pixel
        self.rays = {}  # by key frame
        self.X_W = None


class Odometry:
    def __init__(self, K, distortion, fisheye=False):
        self.K, self.distortion, self.fisheye = K, distortion, fisheye
        self.pixel = 1 / K[0, 0]  # on the plane z = 1
        self.grey, self.tracks = None, []
        self.keyframes = []  # (R_CW, t_CW)
        self.last = None  # pose of the last frame
        self.step = 1.0  # length between the first two key frames
        self.at_keyframe = 0  # landmarks tracked there
        self.waiting = []  # rays of the frames of a start, by track, until its pose is known

    def undistort(self, pixels):
        undistort = cv2.fisheye.undistortPoints if self.fisheye else cv2.undistortPoints
        return undistort(pixels.reshape(-1, 1, 2), self.K, self.distortion).reshape(-1, 2)

    def in_view(self, x, y):
        """Whether pixels are near enough to the axis, by the equidistant projection."""
        radius = WIDEST * self.K[0, 0] if self.fisheye else np.inf
        return np.hypot(x - self.K[0, 2], y - self.K[1, 2]) < radius

    def flow(self, grey):
        """Follows all tracks into the image; those that do not come back to within a pixel end."""
        if not self.tracks:
            return
        before = np.float32([t.pixel for t in self.tracks])
        options = {"winSize": (21, 21), "maxLevel": 4}
        after, found, _ = cv2.calcOpticalFlowPyrLK(self.grey, grey, before, None, **options)
        back, found_back, _ = cv2.calcOpticalFlowPyrLK(grey, self.grey, after, None, **options)
        height, width = grey.shape
        inside = (after > 8).all(1) & (after[:, 0] < width - 8) & (after[:, 1] < height - 8) & self.in_view(*after.T)
        good = (found[:, 0] > 0) & (found_back[:, 0] > 0) & (np.linalg.norm(back - before, axis=1) < 1) & inside
        for track, pixel in zip(self.tracks, after):
            track.pixel = pixel
        self.tracks = [t for t, g in zip(self.tracks, good) if g]

    def detect(self, grey):
        y, x = np.ogrid[:grey.shape[0], :grey.shape[1]]
        mask = np.where(self.in_view(x, y), np.uint8(255), np.uint8(0))
        for track in self.tracks:
            cv2.circle(mask, tuple(int(v) for v in track.pixel), LEAST_DISTANCE_PX, 0, -1)
        wanted = CORNERS - len(self.tracks)
        corners = cv2.goodFeaturesToTrack(grey, wanted, 0.01, LEAST_DISTANCE_PX, mask=mask) if wanted > 0 else None
        self.tracks += [Track(c[0]) for c in corners] if corners is not None else []

    def rays(self):
        return self.undistort(np.float32([t.pixel for t in self.tracks])) if self.tracks else np.zeros((0, 2))

    def add_keyframe(self, pose):
        self.keyframes.append(pose)
        for track, ray in zip(self.tracks, self.rays()):
            track.rays[len(self.keyframes) - 1] = ray

    def process(self, grey):
        """Poses (R_CW, t_CW) by the number of the frame, counted back from this one, that are new."""
        grey = cv2.createCLAHE(2.0, (8, 8)).apply(grey)
        if self.grey is None:
            self.begin(grey, (np.eye(3), np.zeros(3)))
            return {}
        self.flow(grey)
        self.grey = grey
        return self.start() if self.waiting else self.follow()

    def begin(self, grey, pose):
        self.grey, self.tracks, self.last = grey, [], pose
        self.detect(grey)
        self.add_keyframe(pose)
        self.first = len(self.keyframes) - 1
        self.waiting = [None]

    def start(self):
        """Five points from the start's first frame to this one, once the flow is large enough."""
        rays = self.rays()
        self.waiting.append({id(t): r for t, r in zip(self.tracks, rays)})
        seen = [(t, r) for t, r in zip(self.tracks, rays) if self.first in t.rays]
        if len(seen) < 40:
            self.begin(self.grey, self.last)
            return {}
        first = np.array([t.rays[self.first] for t, _ in seen])
        now = np.array([r for _, r in seen])
        if np.median(np.linalg.norm(now - first, axis=1)) * 640 / 2 / self.K[0, 2] < START_PARALLAX_PX * self.pixel:
            return {}
        E, inlier = cv2.findEssentialMat(first, now, np.eye(3), cv2.RANSAC, 0.999, 1.5 * self.pixel)
        if E is None or E.shape != (3, 3):
            return {}
        count, R, t, inlier = cv2.recoverPose(E, first, now, np.eye(3), mask=inlier)
        if count < 0.5 * len(seen) or count < 30:
            return {}
        R0, t0 = self.keyframes[self.first]
        self.add_keyframe((R @ R0, R @ t0 + self.step * t[:, 0]))
        self.triangulate()
        if sum(track.X_W is not None for track in self.tracks) < 20:
            self.keyframes.pop()
            for track in self.tracks:
                track.rays.pop(self.first + 1, None)
            return {}
        self.adjust()
        poses, known = {len(self.waiting) - 1: (R0, t0)}, {id(t): t.X_W for t in self.tracks if t.X_W is not None}
        pose = (R0, t0)
        for back, rays in zip(range(len(self.waiting) - 2, -1, -1), self.waiting[1:]):
            both = [k for k in rays if k in known]
            solved = self.locate(np.array([known[k] for k in both]), np.array([rays[k] for k in both]), pose)
            if solved is not None:
                pose = poses[back] = solved[0]
        self.last, self.waiting = self.keyframes[-1], []
        self.finish_keyframe()
        return poses

    def locate(self, X_W, rays, guess):
        """Pose by PnP with consensus, and its inliers; None where too few agree."""
        if len(X_W) < LEAST_INLIERS:
            return None
        r, t = cv2.Rodrigues(guess[0])[0], guess[1].reshape(3, 1).copy()
        good, r, t, inlier = cv2.solvePnPRansac(X_W, rays, np.eye(3), None, r, t, True, 200,
                                                REPROJECTION_PX * self.pixel, 0.999)
        if not good or inlier is None or len(inlier) < max(LEAST_INLIERS, 0.3 * len(X_W)):
            return None
        inlier = inlier[:, 0]
        r, t = cv2.solvePnPRefineLM(X_W[inlier], rays[inlier], np.eye(3), None, r, t)
        return (cv2.Rodrigues(r)[0], t[:, 0]), inlier

    def follow(self):
        known = [t for t in self.tracks if t.X_W is not None]
        rays = self.undistort(np.float32([t.pixel for t in known])) if known else np.zeros((0, 2))
        solved = self.locate(np.array([t.X_W for t in known]), rays, self.last)
        if solved is None:  # lost: a new start, at the last pose and with the last step
            self.begin(self.grey, self.last)
            return {}
        self.last, inlier = solved
        outliers = {id(t) for i, t in enumerate(known)} - {id(known[i]) for i in inlier}
        self.tracks = [t for t in self.tracks if id(t) not in outliers]
        moved = [np.linalg.norm(r - t.rays[len(self.keyframes) - 1]) for t, r in zip(known, rays)
                 if len(self.keyframes) - 1 in t.rays]
        far = bool(moved) and np.median(moved) > KEYFRAME_PARALLAX_PX * self.pixel
        if far or len(inlier) < KEYFRAME_SHARE * self.at_keyframe:
            self.add_keyframe(self.last)
            self.triangulate()
            self.adjust()
            self.last = self.keyframes[-1]
            self.finish_keyframe()
        return {0: self.last}

    def finish_keyframe(self):
        centre = [-R.T @ t for R, t in self.keyframes[-2:]]
        self.step = max(np.linalg.norm(centre[1] - centre[0]), 1e-9)
        self.at_keyframe = sum(t.X_W is not None for t in self.tracks)
        known = len(self.tracks)
        self.detect(self.grey)
        for track, ray in zip(self.tracks[known:], self.rays()[known:]):
            track.rays[len(self.keyframes) - 1] = ray

    def triangulate(self):
        """Points of the tracks that are seen in an older key frame of this start, under a wide enough angle."""
        now = len(self.keyframes) - 1
        R1, t1 = self.keyframes[now]
        for track in self.tracks:
            older = [k for k in track.rays if self.first <= k < now]
            if track.X_W is not None or not older or now not in track.rays:
                continue
            R0, t0 = self.keyframes[min(older)]
            a, b = (R.T @ np.append(track.rays[k], 1) for R, k in ((R0, min(older)), (R1, now)))
            if np.arccos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1)) < LEAST_ANGLE:
                continue
            X = cv2.triangulatePoints(np.c_[R0, t0], np.c_[R1, t1], track.rays[min(older)], track.rays[now])[:, 0]
            X_W = X[:3] / X[3]
            seen = [(R @ X_W + t, track.rays[k]) for (R, t), k in (((R0, t0), min(older)), ((R1, t1), now))]
            if all(c[2] > 0 and np.linalg.norm(c[:2] / c[2] - z) < REPROJECTION_PX * self.pixel for c, z in seen):
                track.X_W = X_W

    def adjust(self):
        """Bundle adjustment of the last key frames; the two oldest of them, or of the start, hold the gauge."""
        frames = list(range(max(self.first, len(self.keyframes) - WINDOW), len(self.keyframes)))
        free = frames[2:]
        tracks = [t for t in self.tracks if t.X_W is not None and sum(k in t.rays for k in frames) > 1]
        if least_squares is None or not free or len(tracks) < 20:
            return
        views = [(i, k, t.rays[k]) for i, t in enumerate(tracks) for k in frames if k in t.rays]
        which, at = np.array([v[0] for v in views]), np.array([v[1] for v in views])
        z = np.array([v[2] for v in views])
        n = 6 * len(free)

        def poses(x):
            R, t = {k: self.keyframes[k][0] for k in frames}, {k: self.keyframes[k][1] for k in frames}
            for j, k in enumerate(free):
                turn = cv2.Rodrigues(x[6 * j:6 * j + 3])[0]
                R[k], t[k] = turn @ R[k], turn @ t[k] + x[6 * j + 3:6 * j + 6]
            return R, t

        def residuals(x):
            R, t = poses(x)
            X = x[n:].reshape(-1, 3)[which]
            C = np.einsum("nij,nj->ni", np.array([R[k] for k in at]), X) + np.array([t[k] for k in at])
            return ((C[:, :2] / C[:, 2:] - z) / self.pixel).ravel()

        pattern = lil_matrix((2 * len(views), n + 3 * len(tracks)), dtype=int)
        for row, (i, k, _) in enumerate(views):
            pattern[2 * row:2 * row + 2, n + 3 * i:n + 3 * i + 3] = 1
            if k in free:
                j = free.index(k)
                pattern[2 * row:2 * row + 2, 6 * j:6 * j + 6] = 1
        x = np.concatenate([np.zeros(n), np.array([t.X_W for t in tracks]).ravel()])
        x = least_squares(residuals, x, jac_sparsity=pattern, loss="cauchy", x_scale="jac", max_nfev=6).x
        R, t = poses(x)
        for k in free:
            self.keyframes[k] = (R[k], t[k])
        for track, X_W in zip(tracks, x[n:].reshape(-1, 3)):
            track.X_W = X_W


def quaternion(R):
    """x, y, z, w; w >= 0 (Shepperd 1978)."""
    q = np.array([R[0, 0], R[1, 1], R[2, 2], np.trace(R)])
    i = int(np.argmax(q))
    if i == 3:
        q = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], 1 + np.trace(R)])
    else:
        j, k = (i + 1) % 3, (i + 2) % 3
        q[i], q[j], q[k] = 1 + R[i, i] - R[j, j] - R[k, k], R[i, j] + R[j, i], R[i, k] + R[k, i]
        q[3] = R[k, j] - R[j, k]
    return q / np.linalg.norm(q) * (1 if q[3] >= 0 else -1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sequence")
    parser.add_argument("trajectory")
    parser.add_argument("--camera", help="default: camera.yaml of the sequence")
    arguments = parser.parse_args()
    cv2.setNumThreads(1)
    cv2.setRNGSeed(1)
    odometry = Odometry(*read_camera(arguments.camera or os.path.join(arguments.sequence, "camera.yaml")))
    lines = [line.split() for line in open(os.path.join(arguments.sequence, "rgb.txt")) if not line.startswith("#")]
    poses = {}
    for index, (_, name) in enumerate(lines):
        grey = cv2.imread(os.path.join(arguments.sequence, name), cv2.IMREAD_GRAYSCALE)
        if grey is None:
            raise SystemExit(f"{name}: cannot be read")
        for back, pose in odometry.process(grey).items():
            poses[index - back] = pose
    with open(arguments.trajectory, "w") as file:
        for index in sorted(poses):
            R, t = poses[index]
            values = [*(-R.T @ t), *quaternion(R.T)]
            file.write(lines[index][0] + "".join(f" {v:.9f}" for v in values) + "\n")


if __name__ == "__main__":
    main()
