"""What the rooms are built of: surfaces whose materials are known exactly, lamps, and an opening to a sky.

Lengths are in metres, z is up. A material is a diffuse albedo kd plus a Beckmann lobe of albedo ks and width alpha,
which for the alphas used here is close to the Ward lobe that Patina reconstructs.
"""
import math

import bpy
import mathutils


class Material:
    """kd may be a function that builds the nodes of a pattern and returns a colour socket; mean is told then."""

    def __init__(self, name, kd, ks=(0.0, 0.0, 0.0), alpha=0.5):
        self.name, self.kd, self.ks, self.alpha = name, kd, ks if isinstance(ks, tuple) else (ks,) * 3, alpha
        self.blender = bpy.data.materials.new(name)
        self.blender.use_nodes = True
        nodes, links = self.blender.node_tree.nodes, self.blender.node_tree.links
        nodes.clear()
        out, diffuse = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeBsdfDiffuse")
        if callable(kd):
            links.new(kd(nodes, links), diffuse.inputs["Color"])
        else:
            diffuse.inputs["Color"].default_value = (*kd, 1)
        surface = diffuse.outputs[0]
        if max(self.ks) > 0:
            gloss, both = nodes.new("ShaderNodeBsdfGlossy"), nodes.new("ShaderNodeAddShader")
            gloss.distribution = "BECKMANN"
            gloss.inputs["Color"].default_value = (*self.ks, 1)
            gloss.inputs["Roughness"].default_value = math.sqrt(alpha)  # Cycles squares it
            links.new(surface, both.inputs[0])
            links.new(gloss.outputs[0], both.inputs[1])
            surface = both.outputs[0]
        links.new(surface, out.inputs["Surface"])


def _mixed(nodes, links, factor, first, second):
    mix = nodes.new("ShaderNodeMixRGB")
    mix.inputs[1].default_value, mix.inputs[2].default_value = (*first, 1), (*second, 1)
    links.new(factor, mix.inputs[0])
    return mix.outputs[0]


def wood(first, second, scale=3.0):
    def build(nodes, links):
        place, mapping, wave = (nodes.new("ShaderNode" + kind) for kind in ("TexCoord", "Mapping", "TexWave"))
        mapping.inputs["Scale"].default_value = (scale, scale * 0.15, scale)
        wave.inputs["Distortion"].default_value = 6
        links.new(place.outputs["Object"], mapping.inputs["Vector"])
        links.new(mapping.outputs[0], wave.inputs["Vector"])
        return _mixed(nodes, links, wave.outputs["Fac"], first, second)
    return build


def speckled(first, second, scale=25.0):
    def build(nodes, links):
        place, noise = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeTexNoise")
        noise.inputs["Scale"].default_value = scale
        links.new(place.outputs["Object"], noise.inputs["Vector"])
        return _mixed(nodes, links, noise.outputs["Fac"], first, second)
    return build


def tiled(tile, joint, width=0.15, height=0.15, turned=(0, 0, 0)):
    """turned: Euler angles that bring the surface's plane to x and y."""
    def build(nodes, links):
        place, mapping, brick = (nodes.new("ShaderNode" + kind) for kind in ("TexCoord", "Mapping", "TexBrick"))
        mapping.inputs["Rotation"].default_value = turned
        brick.offset = 0
        for name, value in (("Color1", (*tile, 1)), ("Color2", (*tile, 1)), ("Mortar", (*joint, 1)), ("Scale", 1),
                            ("Brick Width", width), ("Row Height", height), ("Mortar Size", 0.004)):
            brick.inputs[name].default_value = value
        links.new(place.outputs["Object"], mapping.inputs["Vector"])
        links.new(mapping.outputs[0], brick.inputs["Vector"])
        return brick.outputs["Color"]
    return build


class Room:
    def __init__(self):
        for thing in list(bpy.data.objects):
            bpy.data.objects.remove(thing)
        self.things, self.lamps = [], []  # things[i] has the id i + 1

    def _add(self, name, material, bevel=0.0, smooth=False):
        thing = bpy.context.object
        thing.name = name
        thing.data.materials.clear()
        thing.data.materials.append(material.blender)
        self.things.append((name, material))
        thing.pass_index = len(self.things)
        if bevel > 0:
            thing.modifiers.new("bevel", "BEVEL").width = bevel
            thing.modifiers["bevel"].segments = 3
        if smooth:
            for polygon in thing.data.polygons:
                polygon.use_smooth = True
        return thing

    def box(self, name, low, high, material, bevel=0.0, turned=0.0):
        centre = [(a + b) / 2 for a, b in zip(low, high)]
        bpy.ops.mesh.primitive_cube_add(size=1, location=centre, rotation=(0, 0, turned))
        bpy.context.object.scale = [b - a for a, b in zip(low, high)]
        bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
        return self._add(name, material, bevel)

    def parts(self, name, boxes, material):
        """One object of several boxes (low, high)."""
        mine = [self.box(name, low, high, material) for low, high in boxes]
        del self.things[len(self.things) - len(boxes) + 1:]
        with bpy.context.temp_override(active_object=mine[0], selected_editable_objects=mine):
            bpy.ops.object.join()
        mine[0].pass_index = len(self.things)
        return mine[0]

    def cylinder(self, name, base, radius, height, material, top_radius=None, open_ends=False, bevel=0.0):
        bpy.ops.mesh.primitive_cone_add(
            vertices=48, radius1=radius, radius2=radius if top_radius is None else top_radius, depth=height,
            end_fill_type="NOTHING" if open_ends else "NGON", location=(base[0], base[1], base[2] + height / 2))
        if open_ends:
            bpy.context.object.modifiers.new("thick", "SOLIDIFY").thickness = 0.006
        return self._add(name, material, bevel, smooth=open_ends)

    def ball(self, name, centre, radius, material, scale=(1, 1, 1)):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=centre)
        bpy.context.object.scale = scale
        return self._add(name, material, smooth=True)

    def ring(self, name, centre, radius, thickness, material, rotation=(0, 0, 0)):
        bpy.ops.mesh.primitive_torus_add(location=centre, major_radius=radius, minor_radius=thickness,
                                         rotation=rotation)
        return self._add(name, material, smooth=True)

    def monkey(self, name, centre, size, material, turned=0.0):
        bpy.ops.mesh.primitive_monkey_add(size=size, location=centre, rotation=(0, 0, turned))
        bpy.context.object.modifiers.new("smooth", "SUBSURF").render_levels = 2
        return self._add(name, material, smooth=True)

    def cloth(self, name, low, high, material, folds=0.02, along="y"):
        """A sheet with folds between two corners of a plane across x or y."""
        size = [b - a for a, b in zip(low, high)]
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=120, y_subdivisions=4, size=1)
        thing = bpy.context.object
        for vertex in thing.data.vertices:
            s, t = vertex.co.x + 0.5, vertex.co.y + 0.5
            wave = folds * math.sin(s * 40)
            vertex.co = ((low[0] + wave, low[1] + s * size[1], low[2] + t * size[2]) if along == "y"
                         else (low[0] + s * size[0], low[1] + wave, low[2] + t * size[2]))
        return self._add(name, material, smooth=True)

    def wall_with_opening(self, name, low, high, along, heights, axis, material):
        """A wall across axis (0: x, 1: y) with a rectangular opening. Returns the wall."""
        other, (a, b), (c, d) = 1 - axis, along, heights

        def part(from_along, to_along, from_z, to_z):
            first, last = list(low), list(high)
            first[other], last[other], first[2], last[2] = from_along, to_along, from_z, to_z
            return first, last
        return self.parts(name, [part(low[other], a, low[2], high[2]), part(b, high[other], low[2], high[2]),
                                 part(a, b, low[2], c), part(a, b, d, high[2])], material)

    def _shining(self, radiance):
        """What the camera and gloss see of the object just made; it lights nothing."""
        material = bpy.data.materials.new("lamp")
        material.use_nodes = True
        material.cycles.sample_as_light = False
        nodes = material.node_tree.nodes
        nodes.clear()
        emission, out = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
        emission.inputs["Color"].default_value = (*radiance, 1)
        material.node_tree.links.new(emission.outputs[0], out.inputs["Surface"])
        thing = bpy.context.object
        thing.data.materials.append(material)
        thing.pass_index = 0
        thing.visible_diffuse = thing.visible_shadow = False

    def _light(self, kind, centre, energy):
        """A light of Blender's, which Cycles finds however small it is. Neither camera nor gloss see it."""
        light = bpy.data.lights.new("lamp", kind)
        light.energy, light.color = max(energy), [value / max(energy) for value in energy]
        thing = bpy.data.objects.new("lamp", light)
        bpy.context.collection.objects.link(thing)
        thing.location = centre
        thing.visible_camera = thing.visible_glossy = False
        return light

    def bulb(self, centre, radius, intensity):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=radius, location=centre)
        self._shining([value / (math.pi * radius * radius) for value in intensity])
        # Cycles: radiance = energy / (4 pi) / (pi radius^2).
        self._light("POINT", centre, [4 * math.pi * value for value in intensity]).shadow_soft_size = radius
        self.lamps.append({"position": list(centre), "intensity": list(intensity)})

    def disc(self, centre, radius, intensity):
        """Shines downwards: intensity straight below."""
        bpy.ops.mesh.primitive_cylinder_add(vertices=48, radius=radius, depth=0.01, location=centre)
        self._shining([value / (math.pi * radius * radius) for value in intensity])
        below = [centre[0], centre[1], centre[2] - 0.005]
        light = self._light("AREA", below, [4 * value for value in intensity])  # Cycles: radiance = energy / (4 area)
        light.shape, light.size = "DISK", 2 * radius
        self.lamps.append({"position": below, "intensity": list(intensity), "axis": [0, 0, -1]})

    def tube(self, low, high, intensity):
        """Shines downwards; no point lamp of the truth stands for it."""
        centre = [(a + b) / 2 for a, b in zip(low, high)]
        bpy.ops.mesh.primitive_cube_add(size=1, location=centre)
        size = [b - a for a, b in zip(low, high)]
        bpy.context.object.scale = size
        self._shining([value / (size[0] * size[1]) for value in intensity])
        light = self._light("AREA", (*centre[:2], low[2]), [4 * value for value in intensity])
        light.shape, light.size, light.size_y = "RECTANGLE", size[0], size[1]

    def sky(self, file, strength, turned):
        """turned: degrees about z. Without a file, a clear sky by Nishita's model."""
        world = bpy.data.worlds.new("sky")
        bpy.context.scene.world = world
        world.use_nodes = True
        nodes, links = world.node_tree.nodes, world.node_tree.links
        background = nodes["Background"]
        background.inputs["Strength"].default_value = strength
        if file is None:
            model = nodes.new("ShaderNodeTexSky")
            model.sun_disc = False
            links.new(model.outputs[0], background.inputs["Color"])
            background.inputs["Strength"].default_value = strength * 0.1  # the model is ten times a picture of a sky
            return
        picture, mapping, place = (nodes.new("ShaderNode" + kind) for kind in ("TexEnvironment", "Mapping", "TexCoord"))
        picture.image = bpy.data.images.load(str(file))
        mapping.inputs["Rotation"].default_value = (0, 0, math.radians(turned))
        links.new(place.outputs["Generated"], mapping.inputs["Vector"])
        links.new(mapping.outputs[0], picture.inputs["Vector"])
        links.new(picture.outputs["Color"], background.inputs["Color"])

    def portal(self, centre, size, direction):
        """Tells Cycles where the sky comes in; it adds no light."""
        light = bpy.data.lights.new("portal", "AREA")
        light.cycles.is_portal = True
        light.shape, light.size, light.size_y = "RECTANGLE", *size
        thing = bpy.data.objects.new("portal", light)
        bpy.context.collection.objects.link(thing)
        thing.location = centre
        thing.rotation_euler = mathutils.Vector(direction).to_track_quat("-Z", "Z").to_euler()

    def sun(self, direction, irradiance):
        """direction: in which it shines; irradiance: of surface that faces it."""
        light = bpy.data.lights.new("sun", "SUN")
        light.energy, light.color = max(irradiance), [value / max(irradiance) for value in irradiance]
        light.angle = 0.009
        thing = bpy.data.objects.new("sun", light)
        bpy.context.collection.objects.link(thing)
        thing.rotation_euler = mathutils.Vector(direction).to_track_quat("-Z", "Y").to_euler()
