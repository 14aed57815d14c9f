"""Opens a run's scene.glb in Blender, ready to render with Cycles:

  blender --python tools/blender_import.py -- RUN [--pose N] [--render OUT.png] [--plain] [--bounces N]

Replaces all objects of the open file. Sets what the importer gets wrong: materials, brightness and radius of lamps,
bulbs, light from afar, colour management. --pose places the camera at pose N of RUN/trajectory.txt, from 0. --render
writes a picture of the recording's size; add -b before --python to do without a window. --plain leaves materials and
lamps as Blender's importer makes them, and sets exposure, colours and ambient light alone. --bounces is how often light
is reflected on its way, 0 as in Patina's re-rendering. docs/guide/blender.md has the same by hand.
"""
import argparse
import json
import math
import pathlib
import struct
import sys

import bpy
import mathutils
import numpy

LUMENS_PER_WATT = 683  # as the importer has it
POINT_LAMP_RADIUS_M = 0.01  # of lamps whose radius is unknown
Z_UP_FROM_Y_UP = mathutils.Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
CAMERA_AXES = mathutils.Matrix.Diagonal((1, -1, -1, 1))  # Blender's cameras look along -z with y up


def description_of(path):
    """The JSON part of a GLB."""
    data = path.read_bytes()
    return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])


def import_scene(path, plain):
    """Returns the root object, whose children are in the recording's world."""
    numpy.bool = bool  # the importer of Debian 12's Blender 3.4 uses this name, which its NumPy 1.24 no longer has
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for material in list(bpy.data.materials):
        bpy.data.materials.remove(material)
    if plain:
        bpy.ops.import_scene.gltf(filepath=str(path))
        return root_object()
    # Unitless: a lamp of intensity I gives a white diffuse surface at distance r the value I / (pi r^2), as in Patina
    # once set_lamps() has brought candela back to pixel values.
    bpy.ops.import_scene.gltf(filepath=str(path), convert_lighting_mode="COMPAT")
    return root_object()


def root_object():
    return next(thing for thing in bpy.data.objects if thing.parent is None)


def node_of(material, kind):
    return next((node for node in material.node_tree.nodes if node.bl_idname == kind), None)


def f0_of(description):
    """What a dielectric of the file reflects at normal incidence, as export/gltf_material.h has it."""
    extensions = description["extensions"]
    ior = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
    specular = extensions.get("KHR_materials_specular", {})
    strength = ((ior - 1) / (ior + 1)) ** 2
    return [min(strength * c, 1) * specular.get("specularFactor", 1)
            for c in specular.get("specularColorFactor", (1, 1, 1))]


def set_material(material, description):
    """Lambert's diffuse reflection plus a GGX lobe without Fresnel's effect, as Ward's model has none."""
    principled = node_of(material, "ShaderNodeBsdfPrincipled")
    color = node_of(material, "ShaderNodeTexImage") or node_of(material, "ShaderNodeVertexColor")
    if not principled or not color:
        return  # a metal, which the importer sets right
    new, link = material.node_tree.nodes.new, material.node_tree.links.new
    surface = node_of(material, "ShaderNodeOutputMaterial").inputs["Surface"]
    if not {"KHR_materials_ior", "KHR_materials_specular"} & set(description.get("extensions", {})):  # fused colours, which hold the recording's light
        link(color.outputs["Color"], surface)
        return
    f0 = f0_of(description)
    dim, diffuse, glossy, both = (new("ShaderNode" + kind)
                                  for kind in ("VectorMath", "BsdfDiffuse", "BsdfGlossy", "AddShader"))
    dim.operation = "SCALE"
    dim.inputs["Scale"].default_value = 1 - max(f0)
    glossy.distribution = "GGX"
    glossy.inputs["Color"].default_value = (*f0, 1)
    glossy.inputs["Roughness"].default_value = description["pbrMetallicRoughness"].get("roughnessFactor", 1)
    link(color.outputs["Color"], dim.inputs[0])
    link(dim.outputs[0], diffuse.inputs["Color"])
    link(diffuse.outputs[0], both.inputs[0])
    link(glossy.outputs[0], both.inputs[1])
    link(both.outputs[0], surface)


def is_bulb_of(lamp, radius_m, mesh_object):
    """Whether the surface of a bulb was recorded, at which its own light would end."""
    center = mesh_object.matrix_world.inverted() @ lamp.matrix_world.translation
    vertices = mesh_object.data.vertices
    near = sum((vertex.co - center).length < 1.5 * radius_m for vertex in vertices)
    return near > len(vertices) / 2


def set_lamps(things, candela_per_intensity):
    for lamp in [thing for thing in things if thing.type == "LIGHT"]:
        lamp.data.energy /= candela_per_intensity
        radius_m = lamp.data.get("radius_m", POINT_LAMP_RADIUS_M)
        if lamp.data.type == "SPOT":  # flat: a disc of Blender, of the same intensity along its axis
            lamp.data.type = "AREA"
            lamp.data.shape = "DISK"
            lamp.data.size = 2 * radius_m
            lamp.data.energy /= math.pi
        else:
            lamp.data.shadow_soft_size = radius_m
        for bulb in [thing for thing in things if thing.type == "MESH" and is_bulb_of(lamp, radius_m, thing)]:
            bulb.visible_shadow = False


def set_world(scene, ambient, strength):
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*ambient, 1)
    background.inputs["Strength"].default_value = strength


def set_environment(scene, picture, strength):
    """Light from afar, which stands beside scene.glb."""
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    environment = nodes.new("ShaderNodeTexEnvironment")
    environment.image = bpy.data.images.load(str(picture.absolute()))
    links.new(environment.outputs["Color"], nodes["Background"].inputs["Color"])
    nodes["Background"].inputs["Strength"].default_value = strength


def luminance_per_pixel_value(extras):
    """Of lamps and of light from afar: where there are both they have one scale."""
    photometric, environment = extras.get("photometric", {}), extras.get("environment", {})
    return photometric.get("candela_per_intensity", environment.get("luminance_per_pixel_value", 1))


def light_from_afar(scene, run, extras, plain):
    luminance = luminance_per_pixel_value(extras)
    picture = run / extras["environment"]["file"] if "environment" in extras else None
    if picture and picture.exists():
        set_environment(scene, picture, 1 / (LUMENS_PER_WATT if plain else luminance))
        return
    lights = run / "lights.json"
    ambient = json.loads(lights.read_text()).get("ambient", (0, 0, 0)) if lights.exists() else (0, 0, 0)
    set_world(scene, ambient, luminance / LUMENS_PER_WATT if plain else 1)


def add_camera(scene, root, pose, camera):
    """`pose` is a pose of trajectory.txt; `camera` has width, height, fx, cx and cy in pixels."""
    x, y, z, qx, qy, qz, qw = map(float, pose.split()[1:])
    turn = mathutils.Quaternion((qw, qx, qy, qz)).to_matrix().to_4x4()
    world_from_camera = mathutils.Matrix.Translation((x, y, z)) @ turn
    data = bpy.data.cameras.new("recorded")
    size = max(camera["width"], camera["height"])
    data.lens = data.sensor_width * camera["fx"] / size
    data.shift_x = ((camera["width"] - 1) / 2 - camera["cx"]) / size
    data.shift_y = (camera["cy"] - (camera["height"] - 1) / 2) / size
    thing = bpy.data.objects.new("recorded", data)
    thing.matrix_world = root.matrix_world @ Z_UP_FROM_Y_UP @ world_from_camera @ CAMERA_AXES
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = camera["width"], camera["height"]


def set_render(scene, bounces):
    scene.view_settings.view_transform = "Standard"
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    if bounces is not None:
        scene.cycles.max_bounces = bounces
    scene.cycles.use_denoising = False  # Debian builds Blender without OpenImageDenoise


def arguments():
    parser = argparse.ArgumentParser(prog="blender --python tools/blender_import.py --")
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("--pose", type=int, default=0)
    parser.add_argument("--render", type=pathlib.Path)
    parser.add_argument("--plain", action="store_true")
    parser.add_argument("--bounces", type=int)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def main():
    given = arguments()
    if bpy.app.version >= (4, 0):
        sys.exit("tools/blender_import.py sets what Blender 3.4's importer makes; this is " + bpy.app.version_string)
    scene = bpy.context.scene
    description = description_of(given.run / "scene.glb")
    extras = description["scenes"][0].get("extras", {})
    luminance = luminance_per_pixel_value(extras)
    root = import_scene(given.run / "scene.glb", given.plain)
    bpy.context.view_layer.update()  # of matrix_world
    if given.plain:
        scene.view_settings.exposure = math.log2(LUMENS_PER_WATT / luminance)
    else:
        for material in description.get("materials", []):
            if material["name"] in bpy.data.materials:
                set_material(bpy.data.materials[material["name"]], material)
        set_lamps(list(bpy.data.objects), luminance)
    light_from_afar(scene, given.run, extras, given.plain)
    poses = [line for line in (given.run / "trajectory.txt").read_text().splitlines() if not line.startswith("#")]
    add_camera(scene, root, poses[given.pose], json.loads((given.run / "run.json").read_text())["sequence"]["depth"])  # whose poses they are
    set_render(scene, given.bounces)
    if given.render:
        scene.render.filepath = str(given.render.absolute())
        bpy.ops.render.render(write_still=True)


main()
