// What the pages have in common: a recorded frame's camera for renderers that look along -z with y up, and shadows.
import * as THREE from 'three';

export const kNear = 0.05, kFar = 100; // metres
export const kShadowSize = 2048; // texels along a side of a lamp's cube

/** From the camera to clip space: a pinhole camera whose pixel (0, 0) is the centre of the top left pixel. */
export function projection({width, height, fx, fy, cx, cy}) {
    const left = -(cx + 0.5) / fx * kNear, right = (width - cx - 0.5) / fx * kNear;
    const top = (cy + 0.5) / fy * kNear, bottom = -(height - cy - 0.5) / fy * kNear;
    return new THREE.Matrix4().makePerspective(left, right, top, bottom, kNear, kFar);
}

/** From the camera to the recording's world, which is below the scene's root. Its own camera looks along +z with y down. */
export function worldFromCamera({colorFromDepth, pose}) {
    const worldFromDepth = new THREE.Matrix4().compose(new THREE.Vector3(...pose.slice(0, 3)),
        new THREE.Quaternion(...pose.slice(3)), new THREE.Vector3(1, 1, 1));
    const depthFromColor = new THREE.Matrix4().set(...colorFromDepth).invert();
    return worldFromDepth.multiply(depthFromColor).scale(new THREE.Vector3(1, -1, -1));
}

/** Sends the canvas as a PNG file. */
export async function send(canvas) {
    const picture = await new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
    await fetch('/picture', {method: 'POST', body: picture});
}

export const fail = (failure) => fetch('/failure', {method: 'POST', body: String(failure)});
