// Where one looks from: a point, two angles and a height, which both kinds of camera share.

import { Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from "./three.js";

const FIELD = 30;
const SLOPE = Math.tan((FIELD * Math.PI) / 360);
const MARGIN = 1.12;

/** Angles of the named views: azimuth from the front, tilt from straight above. */
export const VIEWS = {
  top: [0, 0],
  front: [0, Math.PI / 2],
  side: [Math.PI / 2, Math.PI / 2],
  isometric: [Math.PI / 5, (54 * Math.PI) / 180],
};

export class Eye {
  constructor() {
    this.perspective = false;
    this.target = new Vector3();
    [this.azimuth, this.tilt] = VIEWS.isometric;
    /** What is seen from the lower to the upper edge of the picture, at the target (mm). */
    this.span = 1;
    /** Radius (mm) of all that is to be seen, about `middle`. */
    this.reach = 1;
    this.middle = new Vector3();
    this.flat = new OrthographicCamera();
    this.deep = new PerspectiveCamera(FIELD);
  }

  /** Axes of the picture: right, up, and back towards the eye. */
  axes() {
    const back = new Vector3(
      Math.sin(this.tilt) * Math.sin(this.azimuth),
      -Math.sin(this.tilt) * Math.cos(this.azimuth),
      Math.cos(this.tilt),
    );
    const right = new Vector3(Math.cos(this.azimuth), Math.sin(this.azimuth), 0);
    return { right, up: new Vector3().crossVectors(back, right), back };
  }

  /** The camera of a picture of some aspect. */
  camera(aspect) {
    const { right, up, back } = this.axes();
    const camera = this.perspective ? this.deep : this.flat;
    const far = this.reach + this.middle.distanceTo(this.target);
    const away = this.perspective ? this.span / (2 * SLOPE) : 2 * far;
    if (this.perspective) {
      camera.aspect = aspect;
      camera.near = Math.max(away - far, away / 100);
    } else {
      [camera.top, camera.bottom] = [this.span / 2, -this.span / 2];
      [camera.right, camera.left] = [(this.span * aspect) / 2, (-this.span * aspect) / 2];
      camera.near = 0;
    }
    camera.far = away + far;
    camera.position.copy(this.target).addScaledVector(back, away);
    camera.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(right, up, back));
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
  }

  /** What a fit to points, in a picture of some aspect, would have as target and span. */
  fitted(points, aspect) {
    const { right, up, back } = this.axes();
    const range = (axis) => {
      const values = points.map((point) => point.dot(axis));
      return [Math.min(...values), Math.max(...values)];
    };
    const target = new Vector3();
    for (const axis of [right, up, back]) {
      const [low, high] = range(axis);
      target.addScaledVector(axis, (low + high) / 2);
    }
    const spans = points.map((point) => {
      const away = point.clone().sub(target);
      const deep = this.perspective ? away.dot(back) * SLOPE : 0;
      const high = Math.abs(away.dot(up)) + deep;
      const wide = Math.abs(away.dot(right)) / aspect + deep;
      return 2 * Math.max(high, wide);
    });
    return { target, span: MARGIN * Math.max(...spans, 1e-3) };
  }

  /** Look at all of some points. */
  fit(points, aspect) {
    Object.assign(this, this.fitted(points, aspect));
  }

  orbit(azimuth, tilt) {
    this.azimuth = (this.azimuth + azimuth) % (2 * Math.PI);
    this.tilt = Math.min(Math.max(this.tilt + tilt, 0), Math.PI);
  }

  /** Move by parts of the picture's height. */
  pan(right, up) {
    const axes = this.axes();
    this.target.addScaledVector(axes.right, right * this.span);
    this.target.addScaledVector(axes.up, up * this.span);
  }

  /** Zoom, and keep what is so far right and up of the middle, in heights, where it is. */
  zoom(factor, right = 0, up = 0) {
    const span = Math.min(Math.max(this.span / factor, this.reach / 500), this.reach * 20);
    const kept = 1 - span / this.span;
    this.pan(right * kept, up * kept);
    this.span = span;
  }
}
