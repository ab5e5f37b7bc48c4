// The 3D view of a report: surfaces that the page carries, coloured by a field, turned with a mouse or a finger.
// The page holds JSON in the element "view-data": [{name, points, triangles, displacement, fields}], arrays in base64.
import '@kitware/vtk.js/Rendering/OpenGL/Profiles/Geometry';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkColorTransferFunction from '@kitware/vtk.js/Rendering/Core/ColorTransferFunction';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkGenericRenderWindow from '@kitware/vtk.js/Rendering/Misc/GenericRenderWindow';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';

const BACKGROUND = [0.98, 0.98, 0.97];

function decoded(text, type) {
  return new type(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
}

// Three corners for each triangle, as VTK lists cells: 3, a, b, c, ...
function cellsOf(triangles) {
  const cells = new Uint32Array((triangles.length / 3) * 4);
  for (let i = 0, k = 0; i < triangles.length; i += 3) {
    cells.set([3, triangles[i], triangles[i + 1], triangles[i + 2]], k);
    k += 4;
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

class Surface {
  constructor(content) {
    this.content = content;
    this.rest = decoded(content.points, Float32Array);
    this.displacement = content.displacement ? decoded(content.displacement, Float32Array) : null;
    this.data = vtkPolyData.newInstance();
    this.data.getPoints().setData(Float32Array.from(this.rest), 3);
    this.data.getPolys().setData(cellsOf(decoded(content.triangles, Uint32Array)));
    this.mapper = vtkMapper.newInstance({ interpolateScalarsBeforeMapping: true });
    this.mapper.setInputData(this.data);
    this.actor = vtkActor.newInstance();
    this.actor.setMapper(this.mapper);
    this.actor.getProperty().set({ ambient: 0.75, diffuse: 0.25, specular: 0 }); // little shade: colours are values
    this.actor.getProperty().setOpacity(content.opacity);
  }

  colourBy(field) {
    const values = decoded(field.values, Float32Array);
    const array = vtkDataArray.newInstance({ name: field.name, values, numberOfComponents: 1 });
    const onPoints = field.on === 'points';
    (onPoints ? this.data.getPointData() : this.data.getCellData()).setScalars(array);
    this.mapper.set({ scalarMode: onPoints ? 1 : 2, useLookupTableScalarRange: true });
    this.mapper.setLookupTable(transferFunction(field));
    this.data.modified();
  }

  warp(factor) {
    if (!this.displacement) return;
    this.data.getPoints().setData(this.rest.map((x, k) => x + factor * this.displacement[k]), 3);
    this.data.modified();
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
  const legend = element('div');
  const select = element('select', {}, ...surface.content.fields.map((field) => element('option', { textContent: field.name })));
  const show = () => {
    const field = surface.content.fields[select.selectedIndex];
    surface.colourBy(field);
    legend.replaceChildren(legendOf(field));
    render();
  };
  select.addEventListener('change', show);
  show();
  const parts = [element('label', {}, `${surface.content.name} `, select), legend];
  if (surface.content.opacity < 1) {
    const slider = element('input', { type: 'range', min: 0, max: 1, step: 0.05, value: surface.content.opacity });
    slider.addEventListener('input', () => {
      surface.actor.getProperty().setOpacity(Number(slider.value));
      render();
    });
    parts.push(element('label', {}, 'opacity ', slider));
  }
  return element('div', { className: 'choice' }, ...parts);
}

function start(place, content) {
  const view = vtkGenericRenderWindow.newInstance({ background: BACKGROUND, listenWindowResize: true });
  view.setContainer(place);
  view.resize();
  const render = () => view.getRenderWindow().render();
  const surfaces = content.surfaces.map((one) => new Surface(one));
  surfaces.forEach((surface) => view.getRenderer().addActor(surface.actor));
  const controls = document.getElementById('view-controls');
  controls.append(...surfaces.map((surface) => choices(surface, render)));
  if (content.warp > 0) {
    const slider = element('input', { type: 'range', min: 0, max: 4, step: 0.1, value: 1 });
    const label = element('span');
    const warp = () => {
      const factor = slider.value * content.warp;
      surfaces.forEach((surface) => surface.warp(factor));
      label.textContent = `× ${Number(factor.toPrecision(3))}`;
      render();
    };
    slider.addEventListener('input', warp);
    warp();
    controls.append(element('div', { className: 'choice' }, element('label', {}, 'deformation ', slider, label)));
  }
  const camera = view.getRenderer().getActiveCamera();
  const look = () => {
    camera.setPosition(...content.camera.position);
    camera.setFocalPoint(0, 0, 0);
    camera.setViewUp(...content.camera.up);
    camera.setParallelProjection(true);
    view.getRenderer().resetCamera();
    render();
  };
  const reset = element('button', { textContent: 'reset the view' });
  reset.addEventListener('click', look);
  controls.append(element('div', { className: 'choice' }, reset));
  look();
  // On a phone a finger on the view turns it; the page is scrolled beside it.
  place.style.touchAction = 'none';
}

start(document.getElementById('view'), JSON.parse(document.getElementById('view-data').textContent));
