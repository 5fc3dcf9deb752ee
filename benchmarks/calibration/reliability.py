#!/usr/bin/env python3
"""Fits the verdict's two constants on the rows of igsp_calibrate and draws the reliability plot.

The verdict is confidence = 1 / (1 + 10^(steepness (even_quality - Q)) + rival odds); the rival odds are
sum 10^(steepness (Q_i - Q)), so they follow another steepness by a power when one rival carries the sum.
"""

import argparse
import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.hashsalt": "igsp", "svg.fonttype": "none", "font.size": 9})
import matplotlib.pyplot as plt
import numpy as np

NUMBERS = ("source_points", "target_points", "overlap", "confidence", "quality", "contact_share", "rival_odds",
           "runner_up_share")
COUNTS = ("right", "has_estimate", "registered", "free_directions", "mutual_matches", "agreeing_matches")
FREE_CONFIDENCE = 0.1  # the verdict's cap where a direction is free


def read_rows(paths):
    rows = []
    for path in paths:
        with path.open(newline="") as file:
            rows += csv.DictReader(file)
    for row in rows:
        row.update({name: float(row[name]) for name in NUMBERS}, **{name: int(row[name]) for name in COUNTS})
    return rows


def column(rows, name):
    return np.array([row[name] for row in rows], dtype=float)


def written_constants(rows):
    """(even_quality, steepness) of the program that wrote the rows: without rivals the log odds are a line in Q."""
    clear = [row for row in rows if row["has_estimate"] and not row["rival_odds"] and not row["free_directions"]
             and 1e-4 < row["confidence"] < 1 - 1e-4]
    confidence = column(clear, "confidence")
    steepness, offset = np.polyfit(column(clear, "quality"), np.log10(confidence / (1 - confidence)), 1)
    return round(-offset / steepness, 3), round(steepness, 2)


def confidence_of(rows, constants, written):
    """Confidence with other constants than those the rows were written with."""
    even, steepness = constants
    rivals = column(rows, "rival_odds") ** (steepness / written[1])
    confidence = 1 / (1 + 10 ** (steepness * (even - column(rows, "quality"))) + rivals)
    confidence[column(rows, "free_directions") > 0] = np.minimum(
        confidence[column(rows, "free_directions") > 0], FREE_CONFIDENCE)
    confidence[column(rows, "has_estimate") == 0] = 0
    return confidence


def fit(rows):
    """Logistic regression of right on Q by Newton's method; (even_quality, steepness in decades)."""
    x, y = column(rows, "quality"), column(rows, "right")
    design = np.column_stack([np.ones_like(x), x])
    weights = np.zeros(2)
    for _ in range(100):
        p = 1 / (1 + np.exp(-design @ weights))
        hessian = design.T @ (design * (p * (1 - p))[:, None]) + 1e-9 * np.eye(2)
        step = np.linalg.solve(hessian, design.T @ (y - p))
        weights += step
        if np.abs(step).max() < 1e-10:
            break
    return -weights[0] / weights[1], weights[1] / np.log(10)


def area_under_curve(quality, right):
    """Probability that a right answer has the higher Q (ties count half)."""
    good, bad = quality[right], quality[~right]
    return np.mean((good[:, None] > bad[None]) + 0.5 * (good[:, None] == bad[None]))


def calibration_error(confidence, right, bins=10):
    """Expected calibration error: |mean confidence - share right| of equal bins of confidence, weighted by count."""
    places = np.minimum((confidence * bins).astype(int), bins - 1)
    gaps = [abs(np.sum(confidence[places == b]) - np.sum(right[places == b])) for b in range(bins)]
    return np.sum(gaps) / len(confidence)


def wilson(successes, count, z=1.96):
    share = successes / count
    centre = (share + z**2 / (2 * count)) / (1 + z**2 / count)
    half = z / (1 + z**2 / count) * np.sqrt(share * (1 - share) / count + z**2 / (4 * count**2))
    return centre - half, centre + half


def draw_reliability(confidence, right, path):
    edges = np.array([0, 0.001, 0.01, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99, 0.999, 1.0])
    bins = np.clip(np.searchsorted(edges, confidence, side="right") - 1, 0, len(edges) - 2)
    fig, (top, bottom) = plt.subplots(2, 1, figsize=(6.4, 5.6), height_ratios=(3, 1), sharex=True)
    used = [b for b in range(len(edges) - 1) if np.any(bins == b)]
    shares = [right[bins == b].mean() for b in used]
    limits = [wilson(right[bins == b].sum(), np.sum(bins == b)) for b in used]
    errors = np.array([[s - low, high - s] for s, (low, high) in zip(shares, limits)]).T
    top.step(np.arange(len(edges) - 1), [confidence[bins == b].mean() if np.any(bins == b) else np.nan
                                         for b in range(len(edges) - 1)],
             where="mid", color="0.5", linestyle="--", label="mean confidence said")
    top.errorbar(used, shares, yerr=np.maximum(errors, 0), fmt="ko", capsize=3, markersize=4,
                 label="share that is right, Wilson 95 %")
    top.set_ylabel("right"), top.set_ylim(-0.04, 1.04), top.legend(loc="upper left", frameon=False), top.grid(alpha=0.3)
    positions = np.arange(len(edges) - 1)
    wrong_count = [np.sum((bins == b) & ~right) for b in positions]
    right_count = [np.sum((bins == b) & right) for b in positions]
    bottom.bar(positions, wrong_count, color="white", edgecolor="black", hatch="////", label="wrong")
    bottom.bar(positions, right_count, bottom=wrong_count, color="0.6", edgecolor="black", label="right")
    for b in positions:
        bottom.annotate(str(wrong_count[b] + right_count[b]), (b, wrong_count[b] + right_count[b]), ha="center",
                        va="bottom", fontsize=8)
    bottom.margins(y=0.2), bottom.set_ylabel("answers"), bottom.legend(frameon=False)
    bottom.set_xticks(positions, [f"{a:g}\nto {b:g}" for a, b in zip(edges[:-1], edges[1:])], fontsize=8)
    bottom.set_xlabel("confidence")
    save(fig, path)


def draw_quality(quality, right, even, path):
    edges = np.arange(np.floor(quality.min() * 4) / 4, quality.max() + 0.25, 0.125)
    fig, axes = plt.subplots(figsize=(6.4, 3.2))
    wrong_count = np.histogram(quality[~right], edges)[0]
    axes.bar(edges[:-1], wrong_count, 0.125, align="edge", color="white", edgecolor="black", hatch="////",
             label="wrong")
    axes.bar(edges[:-1], np.histogram(quality[right], edges)[0], 0.125, bottom=wrong_count, align="edge", color="0.6",
             edgecolor="black", label="right")
    axes.axvline(even, color="black", linestyle="--", label=f"as likely right as wrong, Q = {even:.2f}")
    axes.set_xlabel("quality Q"), axes.set_ylabel("answers"), axes.legend(frameon=False)
    save(fig, path)


def save(fig, path):
    fig.tight_layout()
    fig.savefig(path.with_suffix(".svg"), metadata={"Date": None})
    fig.savefig(path.with_suffix(".png"), dpi=110)
    plt.close(fig)


def name_of(row):
    scenes = row["source_scene"] if row["source_scene"] == row["target_scene"] else (
        row["source_scene"] + " / " + row["target_scene"])
    seeds = row["source_seed"] + (" / " + row["target_seed"] if row["target_seed"] != row["source_seed"] else "")
    return f"pair {row['pair']} {row['answer']}: {scenes}, seed {seeds}"


def report_constants(title, rows, constants, written):
    accepted = confidence_of(rows, constants, written) >= 0.5
    right = column(rows, "right") > 0
    print(f"{title}: even_quality {constants[0]:.3f}, steepness {constants[1]:.2f}: "
          f"{np.sum(accepted & right)} right accepted, {np.sum(~accepted & right)} right refused, "
          f"{np.sum(accepted & ~right)} wrong accepted, {np.sum(~accepted & ~right)} wrong refused")


def report_thresholds(answers, hard, steepness, written):
    print("\neven_quality: wrong accepted (of which not indoor), wrong runners-up accepted, right refused")
    for even in np.arange(0.5, 2.05, 0.1):
        accepted = confidence_of(hard, (even, steepness), written) >= 0.5
        right, extra = column(hard, "right") > 0, np.arange(len(hard)) >= len(answers)
        indoor = np.array([row["source_scene"] == "indoor" for row in hard])
        false = accepted & ~right
        print(f"  {even:.1f}: {np.sum(false & ~extra):3d} ({np.sum(false & ~extra & ~indoor)}) "
              f"{np.sum(false & extra):3d} {np.sum(right & ~accepted):3d}")


def report_scenes(rows):
    print("\nscene                     pairs registered  right registered-and-wrong runner-up>0.6 free-direction")
    names = {}
    for row in rows:
        same = row["source_seed"] == row["target_seed"]
        name = row["source_scene"] if same else f"{row['source_scene']} / other {row['target_scene']}"
        names.setdefault((row["kind"], name), []).append(row)
    for (_, name), group in sorted(names.items(), key=lambda item: ("oda".index(item[0][0][0]), item[0][1])):
        registered, right = column(group, "registered") > 0, column(group, "right") > 0
        print(f"{name:25s} {len(group):5d} {registered.sum():10d} {right.sum():6d} {np.sum(registered & ~right):19d} "
              f"{np.sum(column(group, 'runner_up_share') > 0.6):14d} {np.sum(column(group, 'free_directions') > 0):14d}")


def report_overlap(rows):
    print("\nordinary pairs by true overlap: pairs, right, registered, right but refused, wrong but registered")
    overlap = column(rows, "overlap")
    for low, high in ((0, 0.05), (0.05, 0.1), (0.1, 0.2), (0.2, 0.3), (0.3, 0.4), (0.4, 0.6), (0.6, 1.01)):
        group = [row for row, o in zip(rows, overlap) if low <= o < high]
        registered, right = column(group, "registered") > 0, column(group, "right") > 0
        print(f"  {low:4.2f} to {min(high, 1):4.2f}: {len(group):4d} {right.sum():4d} {registered.sum():4d} "
              f"{np.sum(right & ~registered):4d} {np.sum(registered & ~right):4d}")


def report_calibration_error(rows):
    print("\nunambiguous answers: count, mean confidence, share right, expected calibration error (10 bins), Brier score")
    points = np.minimum(column(rows, "source_points"), column(rows, "target_points"))
    scene = np.array([row["source_scene"] for row in rows])
    groups = {"all": points > 0, **{name: scene == name for name in sorted(set(scene))},
              "registered": column(rows, "registered") > 0, "refused": column(rows, "registered") == 0,
              "below 5,000 points": points < 5000, "5,000 to 50,000": (points >= 5000) & (points < 50000),
              "50,000 and more": points >= 50000}
    for name, chosen in groups.items():
        confidence, right = column(rows, "confidence")[chosen], column(rows, "right")[chosen]
        print(f"  {name:20s} {len(right):4d}  {confidence.mean():.3f}  {right.mean():.3f}  "
              f"{calibration_error(confidence, right):.3f}  {np.mean((confidence - right) ** 2):.3f}")


def report_worst(rows):
    wrong = sorted((row for row in rows if not row["right"]), key=lambda row: -row["quality"])
    print("\nwrong answers with the largest Q, not ambiguous:")
    for row in wrong[:12]:
        print(f"  Q {row['quality']:6.3f} confidence {row['confidence']:.3f} overlap {row['overlap']:.2f} "
              f"off by {row['rotation_error_deg']} deg, {row['displacement_voxels']} voxels; contact "
              f"{row['contact_share']:.3f}, {row['agreeing_matches']} of {row['mutual_matches']} matches; {name_of(row)}")


def main():
    here = Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=__doc__)
    thousands = [here / f"docs/data/calibration{name}.csv" for name in ("", "_second", "_third")]
    parser.add_argument("--csv", type=Path, nargs="+", default=thousands)
    parser.add_argument("--images", type=Path, default=here / "docs/images")
    arguments = parser.parse_args()

    rows = read_rows(arguments.csv)
    written = written_constants(rows)
    answers = [row for row in rows if row["answer"] == "answer"]
    clear = [row for row in answers if row["kind"] != "ambiguous" and row["has_estimate"]]
    hard = clear + [row for row in rows if row["answer"] == "runner_up"]
    right = column(clear, "right") > 0
    print(f"{len(answers)} pairs; {len(clear)} unambiguous with an estimate, {right.sum()} of them right; "
          f"{len(hard) - len(clear)} wrong runners-up")
    print(f"AUC of Q: {area_under_curve(column(clear, 'quality'), right):.5f}, with the runners-up "
          f"{area_under_curve(column(hard, 'quality'), column(hard, 'right') > 0):.5f}")
    fitted, fitted_hard = fit(clear), fit(hard)
    for title, group in (("answers", clear), ("answers and runners-up", hard)):
        for label, constants in (("current", written), ("fitted to answers", fitted), ("fitted to both", fitted_hard)):
            report_constants(f"{title}, {label}", group, constants, written)
    report_thresholds(clear, hard, written[1], written)
    outside = [row for row in clear if row["source_scene"] != "indoor"]
    print("fitted without indoor scenes: even_quality {:.3f}, steepness {:.2f}".format(*fit(outside)))
    report_scenes(answers)
    report_overlap([row for row in answers if row["kind"] == "ordinary"])
    report_calibration_error(clear)
    report_worst(hard)

    arguments.images.mkdir(parents=True, exist_ok=True)
    draw_reliability(column(clear, "confidence"), right, arguments.images / "reliability")
    draw_quality(column(hard, "quality"), column(hard, "right") > 0, written[0], arguments.images / "quality")


if __name__ == "__main__":
    main()
