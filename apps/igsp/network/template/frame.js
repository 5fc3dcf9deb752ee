'use strict';
// A frame as the map draws it, and the view of it: orthographic, so that the view from above is a plan.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const n = Math.hypot(...a); return a.map((x) => x / n); };

// x, y, z of one point after the other, as all coordinates of many points here.
function worldPoints(scan) {
  if (scan.world) return scan.world;
  const local = new Float32Array(bytesOf(scan.points_drawn).buffer);
  scan.world = new Float64Array(local.length);
  for (let i = 0; i < local.length; i += 3) {
    scan.world.set(transformed(scan.world_from_scan, [0, 1, 2].map((k) => scan.origin[k] + local[i + k])), i);
  }
  return scan.world;
}

function joined(Kind, parts) {
  const all = new Kind(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

function scatterOf(points) {
  const mean = [0, 0, 0], scatter = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  points.forEach((x, i) => { mean[i % 3] += 3 * x / points.length; });
  for (let p = 0; p < points.length; p += 3) {
    for (let i = 0; i < 3; ++i) {
      for (let j = 0; j < 3; ++j) scatter[i][j] += (points[p + i] - mean[i]) * (points[p + j] - mean[j]);
    }
  }
  return scatter;
}

// The direction in which points spread least: shifted power iteration on their scatter.
function flatDirection(points) {
  const scatter = scatterOf(points), shift = scatter[0][0] + scatter[1][1] + scatter[2][2];
  if (!(shift > 0)) return [0, 0, 1];
  let v = unit([0.1, 0.2, 1]);
  for (let k = 0; k < 200; ++k) v = unit([0, 1, 2].map((i) => shift * v[i] - dot(scatter[i], v)));
  return v[2] < 0 ? v.map((x) => -x) : v;
}

// Of the map: to the right, up on it, and out of it.
function mapAxes(choice, points) {
  let out = upAxes[choice];
  if (!out) {
    out = flatDirection(points);
    out = Object.values(upAxes).find((axis) => dot(axis, out) > Math.cos(15 * Math.PI / 180)) ?? out;
  }
  const first = Math.abs(out[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const right = unit(first.map((x, k) => x - out[k] * dot(out, first)));
  return [right, cross(out, right), out];
}

// Coordinates along the axes, about the middle of their range, and half of that.
function alongAxes(axes, points) {
  const along = new Float64Array(points.length);
  const low = new Array(3).fill(Infinity), high = new Array(3).fill(-Infinity);
  for (let p = 0; p < points.length; p += 3) {
    for (let k = 0; k < 3; ++k) {
      const x = axes[k][0] * points[p] + axes[k][1] * points[p + 1] + axes[k][2] * points[p + 2];
      along[p + k] = x;
      low[k] = Math.min(low[k], x);
      high[k] = Math.max(high[k], x);
    }
  }
  const middle = low.map((x, k) => (x + high[k]) / 2);
  return {points: along.map((x, i) => x - middle[i % 3]), half: low.map((x, k) => (high[k] - x) / 2)};
}

// `points`: all that are drawn, then the stations; `owner` and `distance` of those that are drawn.
function frameOf(component, up) {
  const members = network.components[component], scans = members.map((i) => network.scans[i]);
  const world = joined(Float64Array, [...scans.map(worldPoints), ...scans.map((scan) => scan.place)]);
  const {points, half} = alongAxes(mapAxes(up, world), world), drawn = points.length / 3 - members.length;
  const sizes = scans.map((scan) => worldPoints(scan).length / 3);
  return {
    members, points, half, drawn,
    owner: joined(Uint32Array, members.map((i, m) => new Uint32Array(sizes[m]).fill(i))),
    distance: joined(Uint8Array, scans.map((scan, m) =>
      scan.distances_drawn === null ? new Uint8Array(sizes[m]).fill(255) : bytesOf(scan.distances_drawn))),
    station: new Map(members.map((i, m) => [i, points.slice(3 * (drawn + m), 3 * (drawn + m) + 3)])),
  };
}

// `turn` about the axis out of the map, `tilt` of the eye above it [rad]; `shift` of the picture [pixels].
const looks = {
  above: {turn: 0, tilt: Math.PI / 2, zoom: 1, shift: [0, 0]},
  oblique: {turn: Math.PI / 9, tilt: Math.PI / 5, zoom: 1, shift: [0, 0]},
};

// To the right and up on the screen, and towards the eye.
function axesOf({turn, tilt}) {
  const [c, s, ct, st] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
  return [[c, -s, 0], [s * st, c * st, ct], [-s * ct, -c * ct, st]];
}

// Pixels a unit, so that the box of the frame is in the picture.
function fitOf(frame, look, width, height) {
  const reach = (axis) => axis.reduce((sum, x, k) => sum + Math.abs(x) * frame.half[k], 0);
  const [right, up] = axesOf(look);
  return Math.min((width - 60) / (2 * reach(right) || 1), (height - 60) / (2 * reach(up) || 1));
}

// The scale is that of the view from above, so that turning does not change sizes.
function projectionOf(frame, look, width, height) {
  const axes = axesOf(look), scale = fitOf(frame, looks.above, width, height) * look.zoom;
  const centre = [width / 2 + look.shift[0], height / 2 + look.shift[1]];
  return {axes, scale, centre,
    place: (p) => [centre[0] + scale * dot(axes[0], p), centre[1] - scale * dot(axes[1], p)]};
}
