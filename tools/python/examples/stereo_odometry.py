#!/usr/bin/env python3
"""Stereo odometry in the plainest way: points of one pair, followed in time, and the pose that they are seen from.

    stereo_odometry.py SEQUENCE TRAJECTORY

SEQUENCE: EuRoC's layout with mav0/cam0 and cam1 at the same stamps, calibrations in their sensor.yaml. TRAJECTORY: of
each frame that has a pose, in TUM's format, T_WC of cam0, W the first camera; metres, by the distance of the cameras.
Corners of a key frame are matched across the pair by optical flow along the epipolar line, triangulated, and followed
from frame to frame; each pose is PnP within RANSAC, refined on its inliers. Where too few are left, the next key frame
begins. There is no map and no adjustment. Sources: Shi & Tomasi 1994; Bouguet 2001; Nister, Naroditsky & Bergen 2004,
"Visual odometry"; Hartley & Zisserman 2004, section 12.2; all by OpenCV. Needs python3-opencv.
"""
import json
import pathlib
import re
import sys

import cv2
import numpy as np

CORNERS = 600
LEAST_DISTANCE_PX = 10
EPIPOLAR_PX = 1.0  # from the line, at most
REPROJECTION_PX = 1.5
KEYFRAME_SHARE = 0.6  # of a key frame's points that are still followed
LEAST_INLIERS = 15
FLOW = {"winSize": (21, 21), "maxLevel": 4, "criteria": (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 40, 0.005)}


class Camera:
    """sensor.yaml: K, lens, T_BC."""

    def __init__(self, folder):
        text = (folder / "sensor.yaml").read_text()

        def numbers(key):
            return np.array(json.loads(re.search(rf"\b{key}\s*:\s*(\[[^\]]*\])", text)[1]), float)

        fx, fy, cx, cy = numbers("intrinsics")
        self.K = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        self.lens, self.T_BC = numbers("distortion_coefficients"), numbers("data").reshape(4, 4)
        self.fisheye = bool(re.search(r"distortion_model\s*:\s*equidistant", text))
        self.folder = folder / "data"

    def image(self, stamp):
        image = cv2.imread(str(self.folder / f"{stamp}.png"), cv2.IMREAD_GRAYSCALE)
        if image is None:
            raise SystemExit(f"{self.folder / f'{stamp}.png'}: no image")
        return image

    def undistorted(self, pixels):
        """As a pinhole with the same K would see them."""
        undistort = cv2.fisheye.undistortPoints if self.fisheye else cv2.undistortPoints
        return undistort(pixels.reshape(-1, 1, 2).astype(np.float64), self.K, self.lens, P=self.K).reshape(-1, 2)


def follow(before, after, pixels):
    """Where they are in the other picture, and which came back to where they began."""
    there, found, _ = cv2.calcOpticalFlowPyrLK(before, after, pixels, None, **FLOW)
    back, found_back, _ = cv2.calcOpticalFlowPyrLK(after, before, there, None, **FLOW)
    return there, (found & found_back).ravel().astype(bool) & (np.linalg.norm(back - pixels, axis=1) < 0.5)


def triangulate(left, right, images):
    """Corners of the left picture, and their points in its camera [m]."""
    corners = cv2.goodFeaturesToTrack(images[0], CORNERS, 0.01, LEAST_DISTANCE_PX)
    if corners is None:
        return np.zeros((0, 2), np.float32), np.zeros((0, 3))
    corners = corners.reshape(-1, 2)
    matched, good = follow(*images, corners)
    T = np.linalg.inv(right.T_BC) @ left.T_BC  # maps points from the left camera to the right
    a, b = left.undistorted(corners), right.undistorted(matched)
    t = T[:3, 3]
    F = np.linalg.inv(right.K).T @ np.array([[0, -t[2], t[1]], [t[2], 0, -t[0]], [-t[1], t[0], 0]]) @ T[:3, :3] @ np.linalg.inv(left.K)
    line = np.c_[a, np.ones(len(a))] @ F.T
    good &= np.abs(np.sum(line * np.c_[b, np.ones(len(b))], axis=1)) < EPIPOLAR_PX * np.linalg.norm(line[:, :2], axis=1)
    X = cv2.triangulatePoints(left.K @ np.eye(3, 4), right.K @ T[:3], a.T, b.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        X = (X[:3] / X[3]).T
    good &= np.isfinite(X).all(axis=1) & (X[:, 2] > 0) & (X[:, 2] < 60 * np.linalg.norm(t))
    return corners[good], X[good]


def pose(camera, X, pixels, guess):
    """T_CW of PnP, and its inliers; None where there are too few."""
    if len(X) < LEAST_INLIERS:
        return None
    seen = camera.undistorted(pixels)
    r, t = cv2.Rodrigues(guess[:3, :3])[0], guess[:3, 3:].copy()
    good, r, t, inliers = cv2.solvePnPRansac(X, seen, camera.K, None, r, t, True, 200, REPROJECTION_PX, 0.999)
    if not good or inliers is None or len(inliers) < LEAST_INLIERS:
        return None
    inliers = inliers.ravel()
    r, t = cv2.solvePnPRefineLM(X[inliers], seen[inliers], camera.K, None, r, t)
    return np.r_[np.c_[cv2.Rodrigues(r)[0], t], [[0, 0, 0, 1]]], inliers


def line_of(stamp, T_CW):
    T = np.linalg.inv(T_CW)
    rotation = cv2.Rodrigues(T[:3, :3])[0].ravel()
    angle = np.linalg.norm(rotation)
    q = np.r_[np.sinc(angle / 2 / np.pi) / 2 * rotation, np.cos(angle / 2)]
    return f"{stamp // 10**9}.{stamp % 10**9:09d} " + " ".join(f"{x:.9f}" for x in [*T[:3, 3], *q])


def main(sequence, trajectory):
    mav = pathlib.Path(sequence) / "mav0"
    left, right = Camera(mav / "cam0"), Camera(mav / "cam1")
    stamps = [[int(row.split(",")[0]) for row in (mav / k / "data.csv").read_text().splitlines() if row[:1].isdigit()] for k in ("cam0", "cam1")]
    cv2.setRNGSeed(0)
    T_CW, before, lines = np.eye(4), None, []
    pixels, X_W, began = np.zeros((0, 2), np.float32), np.zeros((0, 3)), 0
    for stamp in sorted(set(stamps[0]) & set(stamps[1])):
        image, found = left.image(stamp), None
        if before is not None and len(pixels) > 0:
            pixels, good = follow(before, image, pixels)
            pixels, X_W = pixels[good], X_W[good]
            found = pose(left, X_W, pixels, T_CW)
            if found:
                T_CW, inliers = found
                pixels, X_W = pixels[inliers], X_W[inliers]
        if found or before is None:
            lines.append(line_of(stamp, T_CW))
        if len(pixels) < max(LEAST_INLIERS, KEYFRAME_SHARE * began):  # a frame that is lost goes on from the last pose
            pixels, X = triangulate(left, right, (image, right.image(stamp)))
            X_W, began = (X - T_CW[:3, 3]) @ T_CW[:3, :3], len(X)
        before = image
    pathlib.Path(trajectory).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
