'use strict';
// Words and tables, and what the reader chooses.

const short = (x, digits = 3) => Number.isFinite(x) ? Number(x.toPrecision(digits)).toString() : '–';
const percent = (x) => `${(100 * x).toFixed(x < 0.0995 && x > 0 ? 1 : 0)} %`;
const count = (n) => n.toLocaleString('en');
const shortName = (name) => name.replace(/^.*[\\/]/, '').replace(/\.[^.]*$/, '');
const degrees = 180 / Math.PI;
const inWords = {used: 'used', unconfirmed: 'unconfirmed', rejected: 'rejected', not_registered: 'not registered'};
const names = (link) => scanNames([link.source, link.target]);
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

let chosenLink = null;

function choose(l) {
  chosenLink = l;
  for (const node of document.querySelectorAll('.chosen')) node.classList.remove('chosen');
  for (const node of document.querySelectorAll(`[data-link="${l}"]`)) node.classList.add('chosen');
  const link = network.links[l], free = link.free_directions;
  document.getElementById('link-text').replaceChildren(
    element('strong', `${names(link)}: ${inWords[link.state]}. `),
    `${link.reason}. ${free.length > 0 ? `Not fixed: ${free.join('; ')}. ` : ''}The pair by itself: `,
    element('code', `igsp align ${quoted(network.scans[link.source].name)} ${quoted(network.scans[link.target].name)} ` +
      `--voxel-size ${network.voxel_size} --html pair.html`));
}

function prepareStations() {
  network.scans.forEach((scan, i) => {
    const own = network.links.filter((link) => link.source === i || link.target === i);
    Object.assign(scan, {
      index: i, place: transformed(scan.world_from_scan, scan.station),
      used: own.filter((link) => link.state === 'used').length,
      unconfirmed: own.filter((link) => link.state === 'unconfirmed').length,
    });
  });
}

function fillLinks(onLink) {
  const shown = {used: true, unconfirmed: true, rejected: true, not_registered: false};
  const rows = () => network.links.filter((link) => shown[link.state]);
  const redraw = fillTable(document.getElementById('links'), linkColumns, rows, (line, link) => {
    const l = network.links.indexOf(link);
    line.classList.add(link.state);
    line.classList.toggle('chosen', l === chosenLink);
    line.setAttribute('data-link', l);
    line.addEventListener('click', () => onLink(l));
  }, (link) => link.reason);
  for (const state of Object.keys(shown)) {
    const label = element('label', '', {class: 'group'});
    const box = element('input', '', {type: 'checkbox', id: `show-${state}-rows`});
    box.checked = shown[state];
    box.addEventListener('change', () => { shown[state] = box.checked; redraw(); });
    label.append(box, ` ${inWords[state]} (${network.counts[state]})`);
    document.getElementById('states').append(label);
  }
  const left = network.counts.not_registered - network.links.filter((link) => link.state === 'not_registered').length;
  document.getElementById('links-note').textContent =
    'Median, RMS: cloud to cloud, distances of the source\'s points from the target\'s surface along its normals, ' +
    'where the network put them. Sigma: standard deviation of the pair\'s translation along the axes of the target, ' +
    'in thousandths of the unit; free: the surfaces do not fix it. ' +
    'Free space: share of the points that lie where the other scanner saw through. Loops: triangles that close; ' +
    'cycle error: of the one that closes best, in sigmas. ' +
    'Pair – network: RMS displacement of the source\'s points between what the pair says and where the network ' +
    'put it.' + (left > 0
      ? ` ${count(left)} pairs that are not registered, those of the lowest confidence, are in links.csv only.` : '');
}

function loopsText({all, closing, shown}) {
  if (all === 0) return 'No three scans are registered with each other.';
  const rest = shown.length < all ? ` The table has the ${count(shown.length)} worst, network.json all.` : '';
  const open = all - closing;
  if (all === 1 && open === 0) return 'The only loop closes.';
  if (open === 0) return `All ${count(all)} loops of three links close.${rest}`;
  return `${count(open)} of ${count(all)} loops of three links ${open === 1 ? 'does' : 'do'} not close: ` +
    `one link of each is wrong.${rest}`;
}

// Of the pairs of one frame whose viewpoints are both known.
function contradictionsText({all, shown}) {
  const known = network.components.some((frame) => frame.filter((i) => network.scans[i].station_known).length > 1);
  if (!known) return 'Not known: it takes two scans of a frame whose scanners\' places are known.';
  if (all === 0) {
    return 'None: of no two scans with known places more than 1 % of one lies where the other scanner saw through.';
  }
  const rest = shown.length < all ? ` The table has the ${count(shown.length)} worst, network.json all.` : '';
  return `${count(all)} ${all === 1 ? 'pair' : 'pairs'} of scans, at the final poses, with more than 1 % of the ` +
    `points of one where the other scanner saw through. People and leaves make a few percent.${rest}`;
}

function fillLoops() {
  const fill = (id, {shown}, columns, text, decorate) => {
    document.getElementById(`${id}-text`).textContent = text;
    if (shown.length > 0) fillTable(document.getElementById(id), columns, () => shown, decorate);
  };
  fill('loops', network.loops, loopColumns, loopsText(network.loops),
    (line, loop) => line.classList.add(loop.closes ? 'used' : 'rejected'));
  fill('contradictions', network.contradictions, contradictionColumns, contradictionsText(network.contradictions),
    () => {});
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

function fillFrames() {
  network.components.forEach((members, c) => {
    if (members.length > 1 || c === 0) {
      document.getElementById('frame').append(
        element('option', `${c + 1}: ${members.length} ${members.length === 1 ? 'scan' : 'scans'}`, {value: c}));
    }
  });
}

function fillScale() {
  document.querySelector('#scale i').style.background = `linear-gradient(to right, ${rampColours.join(',')})`;
  document.getElementById('scale-far').textContent = `${short(network.farthest_coloured)} units or more`;
  const measured = network.scans.some((scan) => scan.distances_drawn !== null);
  document.querySelector('#colour [value=distance]').disabled = !measured;
}

function mapNote(byDistance) {
  const drawn = network.scans.reduce((sum, scan) => sum + worldPoints(scan).length / 3, 0);
  return `Drawn: about ${count(Math.round(drawn))} voxel centroids of all scans. ` + (byDistance
    ? 'Distance: from the surface of the other scans of the frame, along the normal of the nearest of all their ' +
      `voxels; grey where none is within ${short(network.neighbour_reach)} units. `
    : 'Each has the colour of its station. ') +
    'Drag to turn, wheel to zoom, right button to move; or Tab to the map and use the arrow keys, plus and minus.';
}

function mapSettings() {
  const value = (id) => document.getElementById(id).value, checked = (id) => document.getElementById(id).checked;
  return {frame: Number(value('frame')), up: value('up'), byDistance: value('colour') === 'distance',
    points: checked('show-points'), names: checked('show-names'), rejected: checked('show-rejected'),
    pairOnly: checked('pair-only')};
}

const mostNames = 60;  // of more stations they would hide the map

function connectMap(map) {
  document.getElementById('show-names').checked = network.scans.length <= mostNames;
  const show = () => {
    const settings = mapSettings();
    document.getElementById('scale').hidden = !settings.byDistance;
    document.getElementById('map-note').textContent = mapNote(settings.byDistance);
    map.show(settings);
  };
  for (const id of ['frame', 'up', 'colour', 'show-points', 'show-names', 'show-rejected', 'pair-only']) {
    document.getElementById(id).addEventListener('change', show);
  }
  for (const button of document.querySelectorAll('[data-look]')) {
    button.addEventListener('click', () => map.lookFrom(button.dataset.look));
  }
  new ResizeObserver(() => map.draw()).observe(map.stage);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', show);
  show();
}

const network = JSON.parse(document.getElementById('data').textContent);
prepareStations();
fillVerdict();
fillScale();
fillFrames();
const map = network.components.length === 0 ? null : new StationMap(document.getElementById('stage'), chooseEverywhere);
function chooseEverywhere(l) {
  choose(l);
  document.getElementById('pair-only').disabled = false;
  if (map) map.choose(l);
}
fillLinks(chooseEverywhere);
fillLoops();
fillTable(document.getElementById('stations'), stationColumns, () => network.scans, () => {});
fillRun();
if (map) connectMap(map);
