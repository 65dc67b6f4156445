// report.js - draws the charts of a report from the data in the page. Reads nothing else.
(function () {
'use strict';
const data = JSON.parse(document.getElementById('report-data').textContent);
const report = {charts: [], errors: [], ready: false};
window.roverReport = report;  // for the browser test
const $ = (id) => document.getElementById(id);

// Lines differ in dash as well as in colour.
const styles = {
  firmware: {width: 1.4}, truth: {width: 2, dash: [6, 4]}, wheels: {width: 1.6, dash: [9, 3]},
  ground: {width: 1.3, dash: [2, 3]}, front: {width: 1.8}, rear: {width: 1.4, dash: [8, 3]},
  middle: {width: 1.4}, ahead: {width: 1.2, dash: [4, 3]}, ahead_far: {width: 1.2, dash: [2, 3]},
  pitch: {width: 1.6}, roll: {width: 1.4, dash: [8, 3]}, rocker: {width: 1.2, dash: [4, 3]},
  bogie: {width: 1.2, dash: [2, 3]}, bogie_right: {width: 1.2, dash: [7, 2, 2, 2]},
};
const kinds = ['slip_alarm', 'sinkage_alarm', 'lost_lock', 'fault', 'absent', 'gap', 'gap'];
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const narrow = () => window.innerWidth <= 600;

let axis = data.place ? 'place' : 'time';
const axisName = () => axis === 'place' ? data.place : 'Time';
const axisUnit = () => axis === 'place' ? 'm' : 's';
// Spans are [what, time from, time to, place from, place to].
const from = (span) => span[axis === 'place' ? 3 : 1];
const to = (span) => span[axis === 'place' ? 4 : 2];
const number = (value, digits) => value.toFixed(digits).replace('-', '\u2212');

function eachVisible(g, spans, draw) {
  const [left, right] = g.xAxisRange();
  spans.forEach((span, index) => {
    if (to(span) < left || from(span) > right) return;
    const x = g.toDomXCoord(Math.max(from(span), left));
    draw(span, x, Math.max(1.5, g.toDomXCoord(Math.min(to(span), right)) - x), index);
  });
}

// Alarms behind the lines: shaded stretch, and the number of the event where it goes up.
function underlayAlarms(ctx, area, g) {
  const alarms = data.events.map((event, index) => event.concat(index + 1)).filter((e) => e[0] < 2);
  ctx.save();
  eachVisible(g, alarms, (span, x, width) => {
    ctx.globalAlpha = 0.16;
    ctx.fillStyle = colour(kinds[span[0]]);
    ctx.fillRect(x, area.y, width, area.h);
  });
  ctx.restore();
}

function drawPins(ctx, area, g) {
  let free = -Infinity;
  const alarms = data.events.map((event, index) => event.concat(index + 1)).filter((e) => e[0] < 2);
  ctx.save();
  ctx.font = '600 10px system-ui, sans-serif';
  ctx.textAlign = 'center';
  ctx.textBaseline = 'middle';
  eachVisible(g, alarms, (span, x) => {
    const text = String(span[span.length - 1]);
    const half = Math.max(8, ctx.measureText(text).width / 2 + 5);
    const centre = Math.min(Math.max(x, area.x + half), area.x + area.w - half);
    if (centre - half < free) return;
    free = centre + half + 2;
    ctx.fillStyle = colour(kinds[span[0]]);
    ctx.beginPath();
    ctx.roundRect(centre - half, area.y, 2 * half, 15, span[0] === 0 ? 7.5 : 2);
    ctx.fill();
    ctx.fillStyle = colour('panel');
    ctx.fillText(text, centre, area.y + 8);
  });
  ctx.restore();
}

function underlayZero(ctx, area, g) {
  const [low, high] = g.yAxisRange();
  if (low >= 0 || high <= 0) return;
  const y = Math.round(g.toDomYCoord(0)) + 0.5;
  ctx.save();
  ctx.strokeStyle = colour('muted');
  ctx.globalAlpha = 0.6;
  ctx.beginPath();
  ctx.moveTo(area.x, y);
  ctx.lineTo(area.x + area.w, y);
  ctx.stroke();
  ctx.restore();
}

// ---- One zoom and one cursor for all charts ----
let busy = false;
function zoomed(g, initial) {
  if (busy || initial) return;
  busy = true;
  const window_ = g.isZoomed('x') ? g.xAxisRange() : null;
  for (const other of report.charts) if (other !== g) other.updateOptions({dateWindow: window_});
  $('reset').disabled = window_ === null;
  busy = false;
}
function nearestRow(rows, x) {
  let low = 0, high = rows.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (rows[middle][0] < x) low = middle + 1; else high = middle;
  }
  return low > 0 && x - rows[low - 1][0] < rows[low][0] - x ? low - 1 : low;
}
function pointed(g, x) {
  if (busy) return;
  busy = true;
  for (const other of report.charts) {
    if (other !== g && other.rows) other.setSelection(nearestRow(other.rows, x));
  }
  busy = false;
}
function unpointed(g) {
  if (busy) return;
  busy = true;
  for (const other of report.charts) if (other !== g) other.clearSelection();
  busy = false;
}
function setWindow(window_) {
  busy = true;
  for (const g of report.charts) g.updateOptions({dateWindow: window_});
  busy = false;
  $('reset').disabled = window_ === null;
}

// One finger scrolls the page; two zoom the chart.
function interaction() {
  const model = Object.assign({}, Dygraph.defaultInteractionModel);
  for (const name of ['touchstart', 'touchmove', 'touchend']) {
    const handler = model[name];
    model[name] = (event, g, context) => {
      if (event.touches.length > 1 || (name === 'touchend' && context.pinching)) {
        context.pinching = event.touches.length > 1;
        handler(event, g, context);
      }
    };
  }
  return model;
}

// ---- Charts ----
function rowsOf(chart) {
  const columns = chart.series.map((s) => axis === 'place' && s.by_place ? s.by_place : s.values);
  return chart[axis].map((x, row) => {
    const cells = columns.map((column) => column[row]);
    if (chart.sigma) cells[0] = [cells[0], chart.sigma[row]];
    return [x].concat(cells);
  });
}

function legend(chart, info) {
  const known = info.x !== undefined;
  const keys = chart.series.map((series, index) => {
    const style = styles[series.style];
    const dash = style.dash ? (style.dash[0] < 4 ? 'dotted' : 'dashed') : 'solid';
    const value = known && info.series[index].y;
    const text = known && Number.isFinite(value) ? ` <b>${number(value, chart.digits)}</b>` : '';
    return `<span><i class="line" style="border-color:${colour(series.style)};border-top-style:${dash}"></i>` +
      `${series.name}${text}</span>`;
  });
  const at = known ? `<span class="at">at ${number(info.x, 2)} ${axisUnit()}</span>` : '';
  return keys.join('') + at;
}

function common() {
  return {
    width: null, legend: 'always', interactionModel: interaction(),
    gridLineColor: colour('grid'), axisLineColor: colour('line'), gridLineWidth: 1,
    xlabel: `${axisName()} (${axisUnit()})`, xLabelHeight: 16, titleHeight: 0,
    highlightCircleSize: 3, animatedZooms: false, rightGap: 12,
    drawCallback: zoomed,
    highlightCallback: function (event, x) { pointed(this, x); },
    unhighlightCallback: function () { unpointed(this); },
  };
}

function axes(valueWidth) {
  return {
    x: {pixelsPerLabel: narrow() ? 60 : 90, axisLabelFormatter: (v) => number(v, decimals(v)),
        valueFormatter: (v) => v},
    y: {axisLabelWidth: valueWidth, pixelsPerLabel: 34, axisLabelFormatter: yLabel},
  };
}
const decimals = (value) => Math.abs(value - Math.round(value)) < 1e-6 ? 0 : Math.abs(value * 10 - Math.round(value * 10)) < 1e-6 ? 1 : 2;
const yLabel = (value) => {
  for (let digits = 0; digits < 4; ++digits) {
    const scaled = value * 10 ** digits;
    if (Math.abs(scaled - Math.round(scaled)) < 1e-6) return number(value, digits);
  }
  return number(value, 4);
};
const leftWidth = () => narrow() ? 40 : 56;

function seriesOptions(chart) {
  const options = {};
  for (const series of chart.series) {
    const style = styles[series.style];
    options[series.name] = {color: colour(series.style), strokeWidth: style.width, strokePattern: style.dash || null};
  }
  return options;
}

function chartOptions(chart) {
  return Object.assign(common(), {
    labels: [axisName()].concat(chart.series.map((s) => s.name)), labelsDiv: $('legend-' + chart.id),
    legendFormatter: (info) => legend(chart, info),
    errorBars: Boolean(chart.sigma), sigma: 1, fillAlpha: 0.18, axes: axes(leftWidth()),
    series: seriesOptions(chart),
    underlayCallback: (ctx, area, g) => {
      ctx.lineJoin = 'round';  // kept for the lines: mitres of near reversals look like spikes
      underlayAlarms(ctx, area, g);
      underlayZero(ctx, area, g);
    },
    plotter: [Dygraph.Plotters.errorPlotter, Dygraph.Plotters.linePlotter, onTop(drawPins)],
    yRangePad: 18,
  });
}

// dygraphs draws the grid over the underlay, so what must stay readable is drawn by a plotter.
const onTop = (draw) => (e) => {
  if (e.seriesIndex === e.seriesCount - 1) draw(e.drawingContext, e.plotArea, e.dygraph);
};

function drawLanes(ctx, area, g) {
  const height = 12;
  data.lanes.forEach((lane, index) => {
    const top = g.toDomYCoord(data.lanes.length - 1 - index) - 1;
    ctx.save();
    ctx.font = '12px system-ui, sans-serif';
    ctx.textBaseline = 'bottom';
    const width = Math.min(ctx.measureText(lane.text).width, area.w - 4);
    ctx.fillStyle = colour('panel');
    ctx.fillRect(area.x + 1, top - 17, width + 6, 17);
    ctx.fillStyle = colour('ink');
    ctx.fillText(lane.text, area.x + 2, top - 1, area.w - 4);
    ctx.fillStyle = colour('soft');
    ctx.fillRect(area.x, top, area.w, height);
    ctx.beginPath();
    ctx.rect(area.x, top, area.w, height);
    ctx.clip();
    eachVisible(g, lane.spans, (span, x, spanWidth) => {
      ctx.fillStyle = colour(span[0]);
      ctx.fillRect(x, top, spanWidth, height);
    });
    ctx.restore();
  });
}

function laneOptions() {
  const count = data.lanes.length;
  return Object.assign(common(), {
    labels: [axisName(), 'lane'], valueRange: [-0.6, count - 0.4], legend: 'never',
    highlightCircleSize: 0, plotter: onTop(drawLanes),
    axes: {
      x: axes(0).x,
      y: {axisLabelWidth: leftWidth(), ticker: () => [], drawGrid: false},
    },
  });
}

function laneRows() {
  // Two points that are never drawn: the lanes are drawn by hand, dygraphs gives them axis and zoom.
  let low = Infinity, high = -Infinity;
  for (const chart of data.charts) {
    low = Math.min(low, chart[axis][0]);
    high = Math.max(high, chart[axis][chart[axis].length - 1]);
  }
  for (const lane of data.lanes) for (const span of lane.spans) {
    low = Math.min(low, from(span));
    high = Math.max(high, to(span));
  }
  return [[low, 0], [high, 0]];
}

function make(element, rows, options, keepRows) {
  const g = new Dygraph(element, rows, options);
  g.rows = keepRows ? rows : null;
  report.charts.push(g);
}

function drawAll() {
  report.charts.forEach((g) => g.destroy());
  report.charts = [];
  busy = true;
  if (data.lanes.length && $('chart-lanes')) {
    $('chart-lanes').style.height = `${data.lanes.length * 36 + 44}px`;
    make($('chart-lanes'), laneRows(), laneOptions(), false);
  }
  for (const chart of data.charts) make($('chart-' + chart.id), rowsOf(chart), chartOptions(chart), true);
  busy = false;
  $('reset').disabled = true;
  $('by-place').setAttribute('aria-pressed', String(axis === 'place'));
  $('by-time').setAttribute('aria-pressed', String(axis === 'time'));
}

function redraw() {
  const first = report.charts[0];
  const window_ = first.isZoomed('x') ? first.xAxisRange() : null;
  drawAll();
  setWindow(window_);
}

// Paper is narrower than the screen, and white.
function paper(on) {
  document.documentElement.classList.toggle('paper', on);
  redraw();
}

function setUp() {
  if (!$('toolbar')) return;
  drawAll();
  $('toolbar').hidden = false;
  $('by-place').disabled = !data.place;
  $('by-place').addEventListener('click', () => { axis = 'place'; drawAll(); });
  $('by-time').addEventListener('click', () => { axis = 'time'; drawAll(); });
  $('reset').addEventListener('click', () => setWindow(null));
  document.querySelectorAll('.go').forEach((button) => button.addEventListener('click', () => {
    const event = data.events[Number(button.dataset.event)];
    const margin = Math.max(to(event) - from(event), axis === 'place' ? 1 : 30);
    setWindow([from(event) - margin, to(event) + margin]);
    ($('chart-lanes') || document.querySelector('.chart')).scrollIntoView({block: 'center'});
  }));
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  window.addEventListener('beforeprint', () => paper(true));
  window.addEventListener('afterprint', () => paper(false));
}

try {
  setUp();
  report.ready = true;
} catch (error) {
  report.errors.push(String(error && error.stack || error));
  document.querySelectorAll('.chart').forEach((element) => {
    element.classList.add('failed');
    element.textContent = 'This chart could not be drawn by this browser.';
  });
  console.error(error);
}
})();
