'use strict';
// Words and tables, and what the reader chooses.

const short = (x, digits = 3) => Number.isFinite(x) ? Number(x.toPrecision(digits)).toString() : '–';
const percent = (x) => `${(100 * x).toFixed(x < 0.0995 && x > 0 ? 1 : 0)} %`;
const count = (n) => n.toLocaleString('en');
const shortName = (name) => name.replace(/^.*[\\/]/, '').replace(/\.[^.]*$/, '');
const degrees = 180 / Math.PI;
const inWords = {used: 'used', unconfirmed: 'unconfirmed', rejected: 'rejected', not_registered: 'not registered'};
const names = (link) => `${shortName(network.scans[link.source].name)} – ${shortName(network.scans[link.target].name)}`;
const linkTitle = (link) => `${names(link)}: ${inWords[link.state]}, confidence ${link.confidence.toFixed(3)}`;
const quoted = (text) => /^[\w./:-]+$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`;

function element(kind, text, attributes = {}) {
  const node = document.createElement(kind);
  if (text !== undefined) node.textContent = text;
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  return node;
}

function fillVerdict() {
  const whole = network.components.length === 1;
  document.body.className = whole ? 'whole' : 'parted';
  const one = network.components.length > 0 && network.components[0].length > 1;
  document.getElementById('verdict-word').textContent =
    whole ? 'All scans in one frame' : one ? 'Not all scans in one frame' : 'No scans in one frame';
  const [first, second] = network.summary;
  document.getElementById('verdict-title').textContent = first;
  document.getElementById('verdict-text').textContent = second + '.';
  document.title = `igsp network: ${first}`;
  const problems = network.scans.filter((scan) => scan.problem !== null);
  const list = document.getElementById('warnings');
  list.hidden = problems.length === 0;
  for (const scan of problems) list.append(element('li', `${shortName(scan.name)}: ${scan.problem}`));
}

// Columns: title, value to sort by, text, class.
function fillTable(table, columns, rows, decorate) {
  let sortedBy = null, ascending = true;
  const draw = () => {
    const head = element('tr');
    columns.forEach((column, c) => {
      const cell = element('th'), button = element('button', column.title, {type: 'button'});
      button.addEventListener('click', () => {
        ascending = sortedBy === c ? !ascending : column.kind !== 'number';
        sortedBy = c;
        draw();
      });
      cell.append(button);
      head.append(cell);
    });
    const sorted = [...rows()];
    if (sortedBy !== null) {
      const value = columns[sortedBy].value, sign = ascending ? 1 : -1;
      sorted.sort((a, b) => sign * (value(a) < value(b) ? -1 : value(a) > value(b) ? 1 : 0));
    }
    const body = sorted.map((row) => {
      const line = element('tr');
      for (const column of columns) {
        const cell = element('td', (column.text ?? column.value)(row), {class: column.kind ?? ''});
        if (column.decorate) column.decorate(cell, row);
        line.append(cell);
      }
      decorate(line, row);
      return line;
    });
    table.replaceChildren(head, ...body);
  };
  draw();
  return draw;
}

const linkColumns = [
  {title: 'Source', value: (l) => shortName(network.scans[l.source].name)},
  {title: 'Target', value: (l) => shortName(network.scans[l.target].name)},
  {title: 'State', value: (l) => inWords[l.state], kind: 'state'},
  {title: 'Confidence', value: (l) => l.confidence, text: (l) => l.confidence.toFixed(3), kind: 'number'},
  {title: 'Overlap', value: (l) => l.overlap, text: (l) => percent(l.overlap), kind: 'number'},
  {title: 'RMSE', value: (l) => l.rmse, text: (l) => short(l.rmse), kind: 'number'},
  {title: 'Matches', value: (l) => l.agreeing_matches, text: (l) => `${l.agreeing_matches} of ${l.mutual_matches}`,
    kind: 'number'},
  {title: 'Free space', value: (l) => l.violation, text: (l) => percent(l.violation), kind: 'number'},
  {title: 'Loops', value: (l) => l.consistent_triangles, kind: 'number'},
  {title: 'Pair – network', value: (l) => l.residual, text: (l) => l.residual > 0 ? short(l.residual) : '–',
    kind: 'number'},
  {title: 'Why', value: (l) => l.reason, kind: 'why'},
];

const sigma = (scan, from) => Math.sqrt(scan.sigma.slice(from, from + 3).reduce((sum, s) => sum + s * s, 0));
const stationColumns = [
  {title: 'Station', value: (s) => shortName(s.name),
    decorate: (cell, s) => {
      const swatch = element('i', '', {class: 'station'});
      swatch.style.background = stationColour(s.index, 55);
      cell.prepend(swatch);
    }},
  {title: 'Frame', value: (s) => s.component + 1, kind: 'number'},
  {title: 'Position', value: (s) => s.place[0], text: (s) => s.place.map((x) => short(x, 6)).join(', '), kind: 'number',
    decorate: (cell, s) => { if (!s.station_known) cell.style.fontStyle = 'italic'; }},
  {title: 'Sigma, position', value: (s) => sigma(s, 3), text: (s) => short(sigma(s, 3), 2), kind: 'number'},
  {title: 'Sigma, turn [deg]', value: (s) => sigma(s, 0), text: (s) => short(sigma(s, 0) * degrees, 2), kind: 'number'},
  {title: 'Links used', value: (s) => s.used, kind: 'number'},
  {title: 'in no loop', value: (s) => s.unconfirmed, kind: 'number'},
  {title: 'Points', value: (s) => s.points, text: (s) => count(s.points), kind: 'number'},
  {title: 'Problem', value: (s) => s.problem ?? '', kind: 'why'},
];

function choose(l) {
  for (const node of document.querySelectorAll('.chosen')) node.classList.remove('chosen');
  for (const node of document.querySelectorAll(`[data-link="${l}"]`)) node.classList.add('chosen');
  const link = network.links[l];
  document.getElementById('link-text').replaceChildren(
    element('strong', `${names(link)}: ${inWords[link.state]}. `), `${link.reason}. The pair by itself: `,
    element('code', `igsp align ${quoted(network.scans[link.source].name)} ${quoted(network.scans[link.target].name)} ` +
      `--voxel-size ${network.voxel_size} --html pair.html`));
}

function prepareStations() {
  network.scans.forEach((scan, i) => {
    const own = network.links.filter((link) => link.source === i || link.target === i);
    Object.assign(scan, {
      index: i, place: times(scan.world_from_scan, scan.station),
      used: own.filter((link) => link.state === 'used').length,
      unconfirmed: own.filter((link) => link.state === 'unconfirmed').length,
    });
  });
}

function fillLinks() {
  const shown = {used: true, unconfirmed: true, rejected: true, not_registered: false};
  const rows = () => network.links.filter((link) => shown[link.state]);
  const redraw = fillTable(document.getElementById('links'), linkColumns, rows, (line, link) => {
    const l = network.links.indexOf(link);
    line.classList.add(link.state);
    line.setAttribute('data-link', l);
    line.addEventListener('click', () => choose(l));
  });
  for (const state of Object.keys(shown)) {
    const label = element('label', '', {class: 'group'}), box = element('input', '', {type: 'checkbox', id: `show-${state}-rows`});
    box.checked = shown[state];
    box.addEventListener('change', () => { shown[state] = box.checked; redraw(); });
    label.append(box, ` ${inWords[state]} (${network.counts[state]})`);
    document.getElementById('states').append(label);
  }
  const left = network.counts.not_registered - network.links.filter((link) => link.state === 'not_registered').length;
  document.getElementById('links-note').textContent =
    'Free space: share of the points that lie where the other scanner saw through. Loops: triangles that close. ' +
    'Pair – network: RMS displacement of the source\'s points between what the pair says and where the network put it.' +
    (left > 0 ? ` ${count(left)} pairs that are not registered, those of the lowest confidence, are in links.csv only.` : '');
}

function keyValueTable(id, entries) {
  const table = document.getElementById(id);
  for (const [name, value] of entries) {
    const row = element('tr');
    row.append(element('th', name), element('td', value, {class: 'value'}));
    table.append(row);
  }
}

function fillRun() {
  keyValueTable('run', [['Scans', count(network.scans.length)], ['Pairs tried', count(network.pairs_tried)],
    ['Bundle error', `${short(network.bundle_error)} units`], ['Voxel size', `${short(network.voxel_size, 6)} units`],
    ['Frames', count(network.components.filter((frame) => frame.length > 1).length)]]);
  const options = [];
  for (const [section, entries] of Object.entries(network.options)) {
    if (entries === null || typeof entries !== 'object') { options.push([section, String(entries)]); continue; }
    for (const [name, value] of Object.entries(entries)) options.push([`${section}.${name}`, String(value)]);
  }
  keyValueTable('options', options);
  document.getElementById('made-by').textContent = `igsp ${network.igsp} network. Lengths in the unit of the scans.`;
}

function start() {
  const frame = document.getElementById('frame');
  network.components.forEach((members, c) => {
    if (members.length > 1 || c === 0) {
      frame.append(element('option', `${c + 1}: ${members.length} ${members.length === 1 ? 'scan' : 'scans'}`, {value: c}));
    }
  });
  const checked = (id) => document.getElementById(id).checked;
  const redraw = () => {
    if (network.components.length === 0) return;
    drawMap(Number(frame.value), {up: document.getElementById('up').value, points: checked('show-points'),
      names: checked('show-names'), rejected: checked('show-rejected')}, choose);
  };
  for (const id of ['frame', 'up', 'show-points', 'show-names', 'show-rejected']) {
    document.getElementById(id).addEventListener('change', redraw);
  }
  addEventListener('resize', redraw);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  const drawn = network.scans.reduce((sum, scan) => sum + scan.points_drawn.length / 16, 0);
  document.getElementById('map-note').textContent = `Drawn: about ${count(Math.round(drawn))} voxel centroids of all ` +
    'scans, each in the colour of its station.';
  redraw();
}

const network = JSON.parse(document.getElementById('data').textContent);
prepareStations();
fillVerdict();
fillLinks();
fillTable(document.getElementById('stations'), stationColumns, () => network.scans, () => {});
fillRun();
start();
