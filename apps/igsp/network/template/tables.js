'use strict';
// The tables of the page: a click on a title sorts.

// Columns: title, value to sort by, text, kind (of which the class is made), hint.
// `below`: what is said of a row in a line of its own.
function fillTable(table, columns, rows, decorate, below) {
  let sortedBy = null, ascending = true;
  const draw = () => {
    const head = element('tr');
    columns.forEach((column, c) => {
      const cell = element('th', '', {class: column.kind ?? ''});
      const button = element('button', column.title, {type: 'button'});
      if (column.hint) button.title = column.hint;
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
    const body = sorted.flatMap((row) => {
      const line = element('tr');
      for (const column of columns) {
        const cell = element('td', (column.text ?? column.value)(row), {class: column.kind ?? ''});
        if (column.decorate) column.decorate(cell, row);
        line.append(cell);
      }
      const lines = below ? [line, element('tr', undefined, {class: 'below'})] : [line];
      if (below) {
        const cell = element('td', undefined, {colspan: columns.length});
        cell.append(element('div', below(row)));
        lines[1].append(cell);
      }
      for (const one of lines) decorate(one, row);
      return lines;
    });
    table.replaceChildren(head, ...body);
  };
  draw();
  return draw;
}

// What of a link's translation along the target's axes is known, in thousandths so that three numbers find room; the
// worst axis is what it is sorted by.
function strengthText(link) {
  const sigma = link.translation_sigma;
  return sigma === null ? '–' : sigma.map((s) => s === null ? 'free' : short(1000 * s, 2)).join(', ');
}

function weakestAxis(link) {
  const sigma = link.translation_sigma;
  return sigma === null ? -1 : Math.max(...sigma.map((s) => s ?? Infinity));
}

// Where a link is not what two scans say by themselves.
function originText(link) {
  if (link.origin === 'merged') return `with ${count(link.merged.length)} scans merged`;
  return link.origin === 'runner_up' ? 'second best pose' : '';
}

const lengthText = (x) => x > 0 ? short(x, 2) : '–';
const linkColumns = [
  {title: 'Source', value: (l) => shortName(network.scans[l.source].name)},
  {title: 'Target', value: (l) => shortName(network.scans[l.target].name)},
  {title: 'State', value: (l) => inWords[l.state], kind: 'state',
    decorate: (cell, l) => { if (originText(l)) cell.append(element('small', originText(l))); }},
  {title: 'Confidence', value: (l) => l.confidence, text: (l) => l.confidence.toFixed(3), kind: 'number'},
  {title: 'Overlap', value: (l) => l.overlap, text: (l) => percent(l.overlap), kind: 'number'},
  {title: 'Median', value: (l) => l.median_distance, text: (l) => lengthText(l.median_distance), kind: 'number',
    hint: 'Cloud to cloud, along the normals, where the network put the scans'},
  {title: 'RMS', value: (l) => l.rms_distance, text: (l) => lengthText(l.rms_distance), kind: 'number',
    hint: 'Cloud to cloud, along the normals, where the network put the scans'},
  {title: 'Pair RMSE', value: (l) => l.rmse, text: (l) => lengthText(l.rmse), kind: 'number',
    hint: 'Of the inliers, at the pose of the pair by itself'},
  {title: 'Sigma x, y, z [1/1000]', value: weakestAxis, text: strengthText, kind: 'number',
    hint: 'Standard deviation of the translation along the axes of the target, in thousandths of the unit; ' +
      'sorted by the weakest',
    decorate: (cell, l) => { cell.title = l.free_directions.join('; '); }},
  {title: 'Matches', value: (l) => l.agreeing_matches, text: (l) => `${l.agreeing_matches} of ${l.mutual_matches}`,
    kind: 'number'},
  {title: 'Free space', value: (l) => l.violation, text: (l) => percent(l.violation), kind: 'number'},
  {title: 'Loops', value: (l) => l.consistent_triangles, kind: 'number'},
  {title: 'Cycle error', value: (l) => l.cycle_error,
    text: (l) => l.consistent_triangles > 0 ? short(l.cycle_error, 2) : '–', kind: 'number',
    hint: 'Of its loops the one that closes best, in sigmas'},
  {title: 'Pair – network', value: (l) => l.residual, text: (l) => lengthText(l.residual), kind: 'number'},
];

const sigma = (scan, from) => Math.sqrt(scan.sigma.slice(from, from + 3).reduce((sum, s) => sum + s * s, 0));
// To some thousandths of a voxel.
const placeText = (scan) => {
  const digits = 3 - Math.floor(Math.log10(network.voxel_size));
  return scan.place.map((x) => x.toFixed(Math.min(20, Math.max(0, digits)))).join(', ');
};
const stationColumns = [
  {title: 'Station', value: (s) => shortName(s.name), kind: 'name',
    decorate: (cell, s) => {
      const swatch = element('i', '', {class: 'station'});
      swatch.style.background = stationColour(s.index, 55);
      cell.prepend(swatch);
    }},
  {title: 'Frame', value: (s) => s.component + 1, kind: 'number'},
  {title: 'Position', value: (s) => s.place[0], text: placeText, kind: 'number',
    decorate: (cell, s) => { if (!s.station_known) cell.style.fontStyle = 'italic'; }},
  {title: 'Sigma, position', value: (s) => sigma(s, 3), text: (s) => short(sigma(s, 3), 2), kind: 'number'},
  {title: 'Sigma, turn [deg]', value: (s) => sigma(s, 0), text: (s) => short(sigma(s, 0) * degrees, 2), kind: 'number'},
  {title: 'Links used', value: (s) => s.used, kind: 'number'},
  {title: 'in no loop', value: (s) => s.unconfirmed, kind: 'number'},
  {title: 'Points', value: (s) => s.points, text: (s) => count(s.points), kind: 'number'},
  {title: 'Problem', value: (s) => s.problem ?? '', kind: 'why'},
];

const scanNames = (scans) => scans.map((i) => shortName(network.scans[i].name)).join(' – ');
const loopColumns = [
  {title: 'Scans', value: (loop) => scanNames(loop.scans)},
  {title: 'Closes', value: (loop) => loop.closes ? 'yes' : 'no', kind: 'closes'},
  {title: 'Error [sigmas]', value: (loop) => loop.error, text: (loop) => short(loop.error, 2), kind: 'number'},
];
const contradictionColumns = [
  {title: 'Scans', value: (pair) => scanNames(pair.scans)},
  {title: 'Seen through', value: (pair) => pair.violation, text: (pair) => percent(pair.violation), kind: 'number'},
];
