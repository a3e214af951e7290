#!/usr/bin/env python3
"""A tour of `import vobench`, cell by cell (# %%): a frame, a sequence, an odometry, and whether one's own filter is consistent.

    PYTHONPATH=build/release/tools/python python3 tools/python/examples/tour.py [SCENES [OUT]]

SCENES is scenes/ of the checkout by default (/usr/share/vobench/scenes of the package); plots go to OUT (out/tour). Needs matplotlib.
"""
# %%
import pathlib
import sys

import matplotlib
import numpy as np

import vobench

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

scenes = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[3] / "scenes")
out = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "out/tour")
out.mkdir(parents=True, exist_ok=True)

# %% A frame: the picture, the depth of each pixel, and where the camera was.
room = vobench.Simulator(vobench.Scenario(scenes / "room.yaml", {"camera": "{width: 320, height: 240, fx: 262.5, fy: 262.5, cx: 159.5, cy: 119.5}"}))
frame, depth = room.render(60), room.depth(60)
print(f"{frame.image.shape} {frame.image.dtype}, exposed for {1000 * frame.exposure_s:.0f} ms, camera at {frame.truth.p_WC.round(3)} m")
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.3), layout="constrained")
left.imshow(frame.image)
left.set_title("frame.image")
shown = right.imshow(depth, cmap="viridis_r")
right.set_title("simulator.depth(60)")
figure.colorbar(shown, ax=right, label="Z in the camera [m]")
for axes in left, right:
    axes.set_xticks([]), axes.set_yticks([])
figure.savefig(out / "frame.jpg", dpi=110)

# %% A sequence, rendered as it is asked for, and an odometry that follows it frame by frame.
simulator = vobench.Simulator(vobench.Scenario(scenes / "tiny.yaml"))
odometry = vobench.Odometry.of(simulator, seed=1)
estimates, truths = [], []
for frame in simulator:
    estimates.append(odometry.track(frame))
    truths.append(frame.truth)
run = vobench.judge(estimates, truths)
print(f"ATE {100 * vobench.ate(run.estimate, run.truth).position.rmse:.1f} cm over {100 * run.truth.path_length:.0f} cm "
      f"in pictures of 160 x 120, {estimates[-1].diagnostics.matched} features matched at the end")


# %% A filter of one's own on points, without images. This one stands for it: EKF-SLAM, which may claim half of its covariance.
class MyFilter:
    claims = 1.0

    def __init__(self, world):  # it may look at world.camera, world.scenario and world.truth(0)
        self.ekf = vobench.PointOdometry.of(world, "ekfslam")

    def track(self, stamp_ns, ids, pixels):
        estimate = self.ekf.track(stamp_ns, ids, pixels)
        estimate.covariance = self.claims * estimate.covariance
        return estimate


class Bold(MyFilter):
    claims = 0.5


points = vobench.Scenario(scenes / "points.yaml", {"time.duration": "2 s", "world.points.count": 20})
run = vobench.play(vobench.PointWorld(points, seed=1), MyFilter(vobench.PointWorld(points, seed=1)))
seconds = (run.truth.stamps_ns - run.truth.stamps_ns[0]) / 1e9

# %% Its errors in one world, beside what it says of them, and ANEES over fifty worlds.
figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.6), layout="constrained")
for axis, colour in zip(range(3), ("tab:blue", "tab:orange", "tab:green")):
    left.plot(seconds, 100 * run.errors[:, axis], color=colour, label="xyz"[axis])
    left.plot(seconds, 200 * run.sigmas[:, axis], color=colour, lw=0.8, ls="--")
    left.plot(seconds, -200 * run.sigmas[:, axis], color=colour, lw=0.8, ls="--")
left.set(xlabel="time [s]", ylabel="position error [cm]", title="one world: errors, and two sigmas (dashed)")
left.legend()
worlds = range(1, 51)
for kind, colour in (MyFilter, "tab:blue"), (Bold, "tab:red"):
    runs = [vobench.play(world, kind(world)) for world in (vobench.PointWorld(points, seed) for seed in worlds)]
    nees = np.array([run.nees["pose"] for run in runs])[:, 1:]  # the first pose is given
    right.plot(seconds[1:], nees.mean(axis=0) / 6, color=colour, label=kind.__name__)
low, high = vobench.chi2_band(dof=6, runs=len(worlds))
right.axhspan(low / 6, high / 6, color="0.85", label="95 % of consistent ones, at one frame")
right.set(xlabel="time [s]", ylabel="ANEES of the pose / 6", title="fifty worlds: as uncertain as it is wrong?", ylim=(0, 3))
right.legend()
figure.savefig(out / "consistency.jpg", dpi=110)

# %% Pass or fail: frames depend on each other, so the verdict holds them against exact filters of the same worlds.
for kind in MyFilter, Bold:
    print(f"{kind.__name__}: {vobench.test_consistency(points, kind)}")
print(f"The plots are in {out}")
