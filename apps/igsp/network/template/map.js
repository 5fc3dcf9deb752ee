'use strict';
// The map: the stations of a frame with their points behind them and the links between them, and how it is turned.

function svgNode(kind, attributes, text) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', kind);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  if (text !== undefined) node.textContent = text;
  return node;
}

function linkColour(link) {
  const share = Math.round(100 * Math.min(1, Math.max(0, (link.confidence - 0.5) * 2)));
  return `color-mix(in srgb, ${themeColour('--used-high')} ${share}%, ${themeColour('--used-low')})`;
}

class StationMap {
  // onLink: called with the index of a link that was clicked.
  constructor(stage, onLink) {
    this.draw = onceAFrame(() => this.drawNow());
    this.stage = stage;
    this.onLink = onLink;
    this.chosen = null;
    this.look = {...looks.above};
    stage.addEventListener('pointerdown', (event) => this.startDrag(event));
    stage.addEventListener('pointermove', (event) => this.drag(event));
    stage.addEventListener('contextmenu', (event) => event.preventDefault());  // the right button moves
    stage.addEventListener('wheel', (event) => this.zoomByWheel(event), {passive: false});
    stage.addEventListener('keydown', (event) => this.turnByKey(event));
  }

  // settings: frame, up, byDistance, points, names, rejected, pairOnly.
  show(settings) {
    const changed = !this.settings || this.settings.frame !== settings.frame || this.settings.up !== settings.up;
    this.settings = settings;
    if (changed) {
      this.frame = frameOf(settings.frame, settings.up);
      this.look = {...looks.above};
    }
    this.fillLinks();
    this.draw();
  }

  lookFrom(name) {
    const fit = (look) => fitOf(this.frame, look, this.stage.clientWidth, this.stage.clientHeight);
    this.look = {...looks[name], zoom: fit(looks[name]) / fit(looks.above)};
    this.draw();
  }

  choose(l) {
    this.chosen = network.links[l];
    if (this.settings.pairOnly) this.draw();
  }

  drawNow() {
    const {clientWidth: width, clientHeight: height} = this.stage, {settings, chosen} = this;
    const projection = projectionOf(this.frame, this.look, width, height);
    const pair = settings.pairOnly && chosen ? new Set([chosen.source, chosen.target]) : null;
    document.getElementById('map').classList.toggle('pair', pair !== null);
    drawCloud(document.getElementById('points'), this.frame, projection, settings.byDistance,
      settings.points ? pair : new Set());
    this.placeLinks(projection.place);
    drawRuler(projection.scale, width);
  }

  fillLinks() {
    const {frame, settings} = this, inside = new Set(frame.members);
    this.lines = [];
    network.links.forEach((link, l) => {
      if (!inside.has(link.source) || !inside.has(link.target) || link.state === 'not_registered') return;
      if (link.state === 'rejected' && !settings.rejected) return;
      this.lines.push({link, node: this.lineOf(link, l)});
    });
    this.stations = frame.members.map((i) => {
      const circle = svgNode('circle', {r: 6, 'data-scan': i});
      circle.style.fill = stationColour(i, 55);  // the page's policy refuses style attributes
      circle.append(svgNode('title', {}, network.scans[i].name));
      return {at: frame.station.get(i), circle, name: svgNode('text', {}, shortName(network.scans[i].name))};
    });
    document.getElementById('map').replaceChildren(...this.lines.map(({node}) => node),
      ...(settings.names ? this.stations.map(({name}) => name) : []), ...this.stations.map(({circle}) => circle));
  }

  lineOf(link, l) {
    const line = svgNode('line', {class: link.state, 'stroke-width': 3, tabindex: 0, 'data-link': l});
    line.classList.toggle('chosen', link === this.chosen);
    if (link.state === 'used') line.setAttribute('stroke', linkColour(link));
    line.append(svgNode('title', {}, linkTitle(link)));
    line.addEventListener('click', () => this.onLink(l));
    line.addEventListener('keydown', (event) => { if (event.key === 'Enter') this.onLink(l); });
    return line;
  }

  placeLinks(place) {
    const move = (node, names, values) => names.forEach((name, k) => node.setAttribute(name, values[k]));
    for (const {link, node} of this.lines) {
      const ends = [link.source, link.target].flatMap((i) => place(this.frame.station.get(i)));
      move(node, ['x1', 'y1', 'x2', 'y2'], ends);
    }
    for (const {at, circle, name} of this.stations) {
      const [x, y] = place(at);
      move(circle, ['cx', 'cy'], [x, y]);
      move(name, ['x', 'y'], [x + 9, y + 4]);
    }
  }

  startDrag(event) {
    this.dragged = false;
    this.from = [event.clientX, event.clientY];
  }

  drag(event) {
    if (event.buttons === 0 || !this.from) return;
    const [dx, dy] = [event.clientX - this.from[0], event.clientY - this.from[1]];
    if (!this.dragged && Math.hypot(dx, dy) < 4) return;  // a click with an unsteady hand
    if (!this.dragged) this.stage.setPointerCapture(event.pointerId);  // from now on no link takes it for a click
    this.dragged = true;
    this.from = [event.clientX, event.clientY];
    if (event.buttons & 2) this.move(dx, dy);
    else this.turn(dx * 0.008, dy * 0.008);
  }

  move(dx, dy) {
    this.look.shift = [this.look.shift[0] + dx, this.look.shift[1] + dy];
    this.draw();
  }

  turn(about, tilt) {
    this.look.turn += about;
    this.look.tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.look.tilt + tilt));
    this.draw();
  }

  // x, y: from the middle of the stage, what stays where it is.
  zoom(factor, x = 0, y = 0) {
    const zoom = Math.min(200, Math.max(0.2, this.look.zoom * factor)), grown = zoom / this.look.zoom;
    this.look.zoom = zoom;
    this.look.shift = [x + grown * (this.look.shift[0] - x), y + grown * (this.look.shift[1] - y)];
    this.draw();
  }

  zoomByWheel(event) {
    event.preventDefault();
    const box = this.stage.getBoundingClientRect();
    this.zoom(event.deltaY < 0 ? 1.15 : 1 / 1.15, event.clientX - box.left - box.width / 2,
      event.clientY - box.top - box.height / 2);
  }

  turnByKey(event) {
    const angle = Math.PI / 24;
    const actions = {
      ArrowLeft: () => this.turn(angle, 0), ArrowRight: () => this.turn(-angle, 0),
      ArrowUp: () => this.turn(0, angle), ArrowDown: () => this.turn(0, -angle),
      '+': () => this.zoom(1.15), '=': () => this.zoom(1.15), '-': () => this.zoom(1 / 1.15),
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
  }
}

// Lengths across the line of sight.
function drawRuler(scale, width) {
  const longest = width / 4 / scale, power = 10 ** Math.floor(Math.log10(longest));
  const length = [5, 2, 1].map((k) => k * power).find((size) => size <= longest);
  document.querySelector('#ruler i').style.width = `${length * scale}px`;
  document.querySelector('#ruler span').textContent = `${Number(length.toPrecision(1))} units`;
}
