'use strict';
// The map: stations from above with their points behind them, and the links between them.

const times = (rows, p) => rows.slice(0, 3).map((row) => row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const n = Math.hypot(...a); return a.map((x) => x / n); };
const stationColour = (i, lightness) => `hsl(${Math.round(i * 137.508) % 360} 55% ${lightness}%)`;

function worldPoints(scan) {
  if (scan.world) return scan.world;
  const bytes = Uint8Array.from(atob(scan.points_drawn), (letter) => letter.charCodeAt(0));
  const local = new Float32Array(bytes.buffer);
  scan.world = [];
  for (let i = 0; i + 2 < local.length; i += 3) {
    scan.world.push(times(scan.world_from_scan, [0, 1, 2].map((k) => scan.origin[k] + local[i + k])));
  }
  return scan.world;
}

// The direction in which points spread least: shifted power iteration on their scatter.
function flatDirection(points) {
  const mean = [0, 1, 2].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length);
  const scatter = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  for (const p of points) {
    for (let i = 0; i < 3; ++i) {
      for (let j = 0; j < 3; ++j) scatter[i][j] += (p[i] - mean[i]) * (p[j] - mean[j]);
    }
  }
  const shift = scatter[0][0] + scatter[1][1] + scatter[2][2];
  if (!(shift > 0)) return [0, 0, 1];
  let v = unit([0.1, 0.2, 1]);
  for (let k = 0; k < 200; ++k) v = unit([0, 1, 2].map((i) => shift * v[i] - dot(scatter[i], v)));
  return v[2] < 0 ? v.map((x) => -x) : v;
}

// Two axes of the map, as seen from above.
function mapAxes(choice, points) {
  const fixed = {z: [0, 0, 1], y: [0, 1, 0], '-y': [0, -1, 0]};
  let up = fixed[choice];
  if (!up) {
    up = flatDirection(points);
    const near = Object.values(fixed).find((axis) => dot(axis, up) > Math.cos(15 * Math.PI / 180));
    if (near) up = near;
  }
  const first = Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const right = unit(first.map((x, k) => x - up[k] * dot(up, first)));
  return [right, cross(up, right)];
}

function linkColour(link) {
  const style = getComputedStyle(document.documentElement);
  const share = Math.round(100 * Math.min(1, Math.max(0, (link.confidence - 0.5) * 2)));
  return `color-mix(in srgb, ${style.getPropertyValue('--used-high')} ${share}%, ${style.getPropertyValue('--used-low')})`;
}

function drawMap(frame, settings, onLink) {
  const stage = document.getElementById('stage'), width = stage.clientWidth, height = stage.clientHeight;
  const members = network.components[frame], inside = new Set(members);
  const everywhere = members.flatMap((i) => worldPoints(network.scans[i]));
  const places = members.map((i) => times(network.scans[i].world_from_scan, network.scans[i].station));
  const [right, up] = mapAxes(settings.up, everywhere.concat(places));
  const flat = (p) => [dot(right, p), dot(up, p)];
  const range = [Infinity, -Infinity, Infinity, -Infinity];
  for (const [x, y] of everywhere.concat(places).map(flat)) {
    range[0] = Math.min(range[0], x); range[1] = Math.max(range[1], x);
    range[2] = Math.min(range[2], y); range[3] = Math.max(range[3], y);
  }
  const scale = Math.min((width - 60) / (range[1] - range[0] || 1), (height - 60) / (range[3] - range[2] || 1));
  const place = (p) => {
    const [x, y] = flat(p);
    return [width / 2 + scale * (x - (range[0] + range[1]) / 2), height / 2 - scale * (y - (range[2] + range[3]) / 2)];
  };
  drawPoints(members, settings.points, place, width, height);
  drawLinks(members, inside, settings, place, onLink);
  drawRuler(scale, width);
}

function drawPoints(members, shown, place, width, height) {
  const canvas = document.getElementById('points'), ratio = window.devicePixelRatio || 1;
  canvas.width = width * ratio; canvas.height = height * ratio;
  const context = canvas.getContext('2d');
  context.scale(ratio, ratio);
  if (!shown) return;
  const dark = matchMedia('(prefers-color-scheme: dark)').matches;
  context.globalAlpha = 0.55;
  for (const i of members) {
    context.fillStyle = stationColour(i, dark ? 62 : 48);
    for (const p of worldPoints(network.scans[i])) {
      const [x, y] = place(p);
      context.fillRect(x - 0.75, y - 0.75, 1.5, 1.5);
    }
  }
}

function svgNode(kind, attributes, text) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', kind);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  if (text !== undefined) node.textContent = text;
  return node;
}

function drawLinks(members, inside, settings, place, onLink) {
  const map = document.getElementById('map');
  map.replaceChildren();
  const at = new Map(members.map((i) => [i, place(times(network.scans[i].world_from_scan, network.scans[i].station))]));
  network.links.forEach((link, l) => {
    if (!inside.has(link.source) || !inside.has(link.target) || link.state === 'not_registered') return;
    if (link.state === 'rejected' && !settings.rejected) return;
    const [[x1, y1], [x2, y2]] = [at.get(link.source), at.get(link.target)];
    const line = svgNode('line', {x1, y1, x2, y2, class: link.state, 'stroke-width': 3, tabindex: 0, 'data-link': l});
    if (link.state === 'used') line.setAttribute('stroke', linkColour(link));
    line.append(svgNode('title', {}, linkTitle(link)));
    line.addEventListener('click', () => onLink(l));
    line.addEventListener('keydown', (event) => { if (event.key === 'Enter') onLink(l); });
    map.append(line);
  });
  for (const i of members) {
    const [cx, cy] = at.get(i);
    const circle = svgNode('circle', {cx, cy, r: 6, 'data-scan': i});
    circle.style.fill = stationColour(i, 55);  // the page's policy refuses style attributes
    circle.append(svgNode('title', {}, network.scans[i].name));
    map.append(circle);
    if (settings.names) map.append(svgNode('text', {x: cx + 9, y: cy + 4}, shortName(network.scans[i].name)));
  }
}

function drawRuler(scale, width) {
  const longest = width / 4 / scale, power = 10 ** Math.floor(Math.log10(longest));
  const length = [5, 2, 1].map((k) => k * power).find((size) => size <= longest);
  document.querySelector('#ruler i').style.width = `${length * scale}px`;
  document.querySelector('#ruler span').textContent = `${Number(length.toPrecision(1))} units`;
}
