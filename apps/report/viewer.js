// The 3D view of a report: surfaces coloured by a field at the steps of a run, edges of the rock, wells, and the
// numbers of a fracture that is clicked. The element "view-data" holds the data as JSON; see view.py.
import '@kitware/vtk.js/Rendering/OpenGL/Profiles/Geometry';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkCellPicker from '@kitware/vtk.js/Rendering/Core/CellPicker';
import vtkColorTransferFunction from '@kitware/vtk.js/Rendering/Core/ColorTransferFunction';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkGenericRenderWindow from '@kitware/vtk.js/Rendering/Misc/GenericRenderWindow';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';

const BACKGROUND = [0.98, 0.98, 0.97];
const FAINT = [0.54, 0.56, 0.6];
const PICKED = [0.93, 0.2, 0.47];
const WELL = [0, 0.47, 0.73];
const LARGEST = 65535; // of 16 bits
const STILL = 4; // largest move of the pointer in a click, in pixels
const PAUSE = 400; // milliseconds between two steps of the animation

function decoded(text, type) {
  return new type(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
}

// Cells as VTK lists them: n, a, b, ..., n, c, d, ...
function cellsOf(corners, n) {
  const cells = new Uint32Array((corners.length / n) * (n + 1));
  for (let i = 0, k = 0; i < corners.length; i += n, k += n + 1) {
    cells[k] = n;
    cells.set(corners.slice(i, i + n), k + 1);
  }
  return cells;
}

// colours: [[r, g, b], ...], evenly over the range.
function transferFunction(field) {
  const [low, high] = field.range;
  const map = vtkColorTransferFunction.newInstance();
  field.colours.forEach((rgb, k) => map.addRGBPoint(low + ((high - low) * k) / (field.colours.length - 1), ...rgb));
  return map;
}

function css(rgb) {
  return `rgb(${rgb.map((part) => Math.round(255 * part)).join(',')})`;
}

function element(kind, properties, ...children) {
  const made = Object.assign(document.createElement(kind), properties);
  made.append(...children);
  return made;
}

// A range with a function for its input.
function slider(properties, changed) {
  const made = element('input', { type: 'range', ...properties });
  made.addEventListener('input', () => changed(Number(made.value)));
  return made;
}

function select(names, changed) {
  const made = element('select', {}, ...names.map((name) => element('option', { textContent: name })));
  made.addEventListener('change', () => changed(made.selectedIndex));
  return made;
}

function actorOf(mapper, data, look) {
  mapper.setInputData(data);
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.getProperty().set(look);
  return actor;
}

// Lines between pairs of points.
class Lines {
  constructor(colour, lineWidth) {
    this.data = vtkPolyData.newInstance();
    this.actor = actorOf(vtkMapper.newInstance(), this.data, { color: colour, lineWidth, lighting: false });
  }

  show(points, pairs) {
    this.data.getPoints().setData(Float32Array.from(points), 3);
    this.data.getLines().setData(cellsOf(pairs, 2));
    this.data.modified();
  }
}

class Surface {
  constructor(content, array) {
    this.content = content;
    this.array = array;
    this.field = 0;
    this.factor = 0;
    this.mapper = vtkMapper.newInstance({ interpolateScalarsBeforeMapping: true });
    // Little shade: colours are values.
    this.actor = actorOf(this.mapper, vtkPolyData.newInstance(), { ambient: 0.75, diffuse: 0.25, specular: 0, opacity: content.opacity });
  }

  // Shows a step; steps without this surface hide it.
  at(step) {
    const frame = this.content.frames[step];
    this.actor.setVisibility(frame !== null);
    if (!frame) return;
    if (!this.frame || frame.triangles !== this.frame.triangles) {
      this.data = vtkPolyData.newInstance();
      this.data.getPolys().setData(cellsOf(this.array(frame.triangles, Uint32Array), 3));
      this.mapper.setInputData(this.data);
    }
    this.frame = frame;
    this.move();
    this.colour();
  }

  move() {
    if (!this.frame) return;
    const rest = this.array(this.frame.points, Float32Array);
    const displacement = this.array(this.frame.displacement, Int16Array);
    const factor = this.factor * this.content.scale;
    this.data.getPoints().setData(rest.map((x, k) => x + factor * displacement[k]), 3);
    this.data.modified();
  }

  colour() {
    if (!this.frame) return;
    const field = this.content.fields[this.field];
    const [low, high] = field.range;
    const parts = this.array(this.frame.values[this.field], Uint16Array);
    const value = (part) => low + ((high - low) * part) / LARGEST;
    const onPoints = field.on === 'points';
    const values = onPoints ? Float32Array.from(parts, value)
      : Float32Array.from(this.array(this.frame.owner, Uint32Array), (polygon) => value(parts[polygon]));
    const scalars = vtkDataArray.newInstance({ name: field.name, values, numberOfComponents: 1 });
    (onPoints ? this.data.getCellData() : this.data.getPointData()).setScalars(null);
    (onPoints ? this.data.getPointData() : this.data.getCellData()).setScalars(scalars);
    this.mapper.set({ scalarMode: onPoints ? 1 : 2, useLookupTableScalarRange: true });
    this.mapper.setLookupTable(transferFunction(field));
    this.data.modified();
  }

  // The number of the fracture of a triangle.
  fractureOf(triangle) {
    return this.array(this.frame.numbers, Uint16Array)[this.array(this.frame.owner, Uint32Array)[triangle]];
  }

  // Pairs of points: edges of a fracture that belong to one of its triangles only.
  rimOf(number) {
    const corners = this.array(this.frame.triangles, Uint32Array);
    const found = new Map();
    for (let t = 0; t < corners.length / 3; t += 1) {
      for (let k = 0; k < 3 && this.fractureOf(t) === number; k += 1) {
        const ends = [corners[3 * t + k], corners[3 * t + ((k + 1) % 3)]];
        const key = [Math.min(...ends), Math.max(...ends)].join();
        if (!found.delete(key)) found.set(key, ends);
      }
    }
    return [...found.values()].flat();
  }
}

// A bar with the ends of its range, or a box for each of a few states.
function legendOf(field) {
  if (field.states) {
    const boxes = field.states.map((name, k) =>
      element('span', { className: 'state' }, element('i', { style: `background:${css(field.colours[k])}` }), name));
    return element('div', { className: 'bar' }, ...boxes);
  }
  const gradient = `background:linear-gradient(to right,${field.colours.map(css).join(',')})`;
  return element('div', { className: 'bar' }, element('span', { textContent: field.low }),
    element('i', { style: gradient }), element('span', { textContent: field.high }));
}

function choices(surface, render) {
  const { content } = surface;
  const legend = element('div', {}, legendOf(content.fields[0]));
  const fields = select(content.fields.map((field) => field.name), (chosen) => {
    surface.field = chosen;
    surface.colour();
    legend.replaceChildren(legendOf(content.fields[chosen]));
    render();
  });
  const opacity = slider({ min: 0, max: 1, step: 0.05, value: content.opacity }, (value) => {
    surface.actor.getProperty().setOpacity(value);
    render();
  });
  return element('div', { className: 'choice' }, element('label', {}, `${content.name} `, fields), legend,
    element('label', {}, 'opacity ', opacity));
}

// Texts at places in space; returns a function that moves them to their pixels.
function textsOf(place, renderer, texts) {
  const made = texts.map(({ text, at, className }) => [place.appendChild(element('span', { className, textContent: text })), at]);
  return () => {
    const [width, height] = [place.clientWidth, place.clientHeight];
    made.forEach(([text, at]) => {
      const [x, y] = renderer.worldToNormalizedDisplay(...at, width / height);
      Object.assign(text.style, { left: `${x * width}px`, top: `${(1 - y) * height}px` });
    });
  };
}

// The facts of a fracture and its numbers at a step.
function table(content, number, step) {
  const { name, facts } = content.fractures[number];
  const rows = [...facts, ...content.tables.map((one) => [one.name, one.values[step][number]])];
  return element('table', {}, element('caption', { textContent: `${name}, ${content.times[step]}` }),
    ...rows.map((row) => element('tr', {}, ...row.map((text) => element('td', { textContent: text })))));
}

function start(place, content) {
  const known = new Map();
  const array = (number, type) => known.get(number) || known.set(number, decoded(content.arrays[number], type)).get(number);
  const view = vtkGenericRenderWindow.newInstance({ background: BACKGROUND, listenWindowResize: true });
  view.setContainer(place);
  view.resize();
  const renderer = view.getRenderer();
  const render = () => view.getRenderWindow().render();
  const surfaces = content.surfaces.map((one) => new Surface(one, array));
  const fractures = surfaces.find((surface) => surface.content.name === 'fractures' && content.fractures.length);
  const edges = new Lines(FAINT, 1);
  const rim = new Lines(PICKED, 4);
  const corners = array(content.edges, Float32Array);
  edges.show(corners, Uint32Array.from({ length: corners.length / 3 }, (_, k) => k));
  const wells = content.wells.filter((well) => well.points.length > 1).map((well) => {
    const lines = new Lines(WELL, 5);
    lines.show(well.points.flat(), well.points.slice(1).flatMap((_, k) => [k, k + 1]));
    return lines;
  });
  [...surfaces, edges, rim, ...wells].forEach((one) => renderer.addActor(one.actor));
  const moveTexts = textsOf(place, renderer, [
    ...content.labels.map((label) => ({ ...label, className: 'place' })),
    ...content.wells.map(({ name, points }) => ({ text: `● ${name}`, at: points[0], className: 'place well' })),
  ]);

  let step = content.times.length - 1;
  let picked = -1;
  const facts = document.getElementById('view-facts');
  const show = () => {
    const visible = picked >= 0 && fractures.frame && fractures.content.frames[step];
    rim.actor.setVisibility(Boolean(visible));
    if (visible) rim.show(fractures.data.getPoints().getData(), fractures.rimOf(picked));
    facts.replaceChildren(...(picked >= 0 ? [table(content, picked, step)] : []));
    render();
    moveTexts();
  };

  const controls = document.getElementById('view-controls');
  controls.append(...surfaces.map((surface) => choices(surface, render)));
  const label = element('span', { id: 'view-time' });
  const go = (to) => {
    step = to;
    surfaces.forEach((surface) => surface.at(step));
    label.textContent = content.times[step];
    show();
  };
  if (content.times.length > 1) {
    const time = slider({ id: 'view-step', min: 0, max: step, step: 1, value: step }, go);
    let playing = null;
    const play = element('button', { textContent: 'play' });
    play.addEventListener('click', () => {
      clearInterval(playing);
      playing = playing ? null : setInterval(() => {
        time.value = (step + 1) % content.times.length;
        go(Number(time.value));
      }, PAUSE);
      play.textContent = playing ? 'stop' : 'play';
    });
    controls.append(element('div', { className: 'choice' }, element('label', {}, 'time ', time, label), play));
  }
  if (content.warp > 0) {
    const factor = element('span');
    const warp = (times) => {
      surfaces.forEach((surface) => { surface.factor = times * content.warp; surface.move(); });
      factor.textContent = `× ${Number((times * content.warp).toPrecision(3))}`;
      show();
    };
    const times = slider({ min: 0, max: 4, step: 0.1, value: 1 }, warp);
    controls.append(element('div', { className: 'choice' }, element('label', {}, 'deformation ', times, factor)));
    warp(1);
  }
  if (fractures) {
    const names = select(['no fracture', ...content.fractures.map((one) => one.name)], (chosen) => {
      picked = chosen - 1;
      show();
    });
    names.id = 'view-fracture';
    controls.append(element('div', { className: 'choice' }, names));
    const picker = vtkCellPicker.newInstance({ tolerance: 0, pickFromList: true });
    picker.setPickList([fractures.actor]);
    let pressed = null;
    view.getInteractor().onLeftButtonPress(({ position }) => { pressed = position; });
    view.getInteractor().onLeftButtonRelease(({ position }) => {
      if (!pressed || Math.hypot(position.x - pressed.x, position.y - pressed.y) > STILL) return;
      picker.pick([position.x, position.y, 0], renderer);
      const triangle = picker.getCellId();
      picked = triangle >= 0 ? fractures.fractureOf(triangle) : -1;
      names.selectedIndex = picked + 1;
      show();
    });
  }
  const camera = renderer.getActiveCamera();
  camera.onModified(moveTexts);
  window.addEventListener('resize', moveTexts);
  const look = () => {
    camera.setPosition(...content.camera.position);
    camera.setFocalPoint(0, 0, 0);
    camera.setViewUp(...content.camera.up);
    camera.setParallelProjection(true);
    renderer.resetCamera();
    show();
  };
  const reset = element('button', { textContent: 'reset the view' });
  reset.addEventListener('click', look);
  controls.append(element('div', { className: 'choice' }, reset));
  go(step);
  look();
  // On a phone a finger on the view turns it; the page is scrolled beside it.
  place.style.touchAction = 'none';
}

start(document.getElementById('view'), JSON.parse(document.getElementById('view-data').textContent));
