"""blender --background --python read_blender.py -- FILE.glb RADIUS OUT.png: what Blender finds
in a .glb, as a line of JSON after "found ": points of lines, points of every frame in the world;
and its picture of the last frame, of tubes of this radius (m), by Cycles on the processor.
"""

import json
import sys

import bpy
import numpy

file, radius, picture = sys.argv[sys.argv.index("--") + 1 :]

# Debian's importer asks its numpy for a name that this has dropped.
numpy.bool = bool

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
bpy.ops.preferences.addon_enable(module="cycles")
bpy.ops.import_scene.gltf(filepath=file)
scene = bpy.context.scene
(lines,) = (thing for thing in bpy.data.objects if thing.type == "MESH")


def counts(mesh):
    """Points of each line of edges that go on where the one before ends."""
    found, last = [], None
    for a, b in (sorted(edge.vertices) for edge in mesh.edges):
        if a != last:
            found.append(1)
        found[-1] += 1
        last = b
    return found


def points():
    mesh = lines.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    world = lines.matrix_world
    return [x for vertex in mesh.vertices for x in world @ vertex.co]


keys = lines.data.shape_keys.animation_data.action.fcurves[0].keyframe_points
frames = []
for key in keys:
    whole = int(key.co.x)
    scene.frame_set(whole, subframe=key.co.x - whole)
    frames.append({"points": points()})
fps = scene.render.fps
times = [key.co.x / fps for key in keys]
found = {"counts": counts(lines.data), "frames": frames, "times": times}
print("found", json.dumps(found))

# The picture, from the side, of all lines as tubes.
corners = numpy.array(frames[-1]["points"]).reshape(-1, 3)
low, high = corners.min(axis=0), corners.max(axis=0)
centre, size = (low + high) / 2, (high - low).max()
lines.select_set(True)
bpy.context.view_layer.objects.active = lines
bpy.ops.object.convert(target="CURVE")
lines.data.bevel_depth = float(radius)
lines.data.bevel_resolution = 0
camera = bpy.data.cameras.new("camera")
camera.type = "ORTHO"
camera.ortho_scale = 1.2 * size
camera.clip_start = 1e-3 * size
seen = bpy.data.objects.new("camera", camera)
seen.location = centre - numpy.array([0, 2 * size, 0])
seen.rotation_euler = (numpy.pi / 2, 0, 0)
scene.collection.objects.link(seen)
scene.camera = seen
scene.world = bpy.data.worlds.new("world")  # grey from everywhere
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 4
scene.cycles.use_denoising = False  # Debian's is built without
scene.render.film_transparent = True
scene.render.resolution_x = scene.render.resolution_y = 128
scene.render.image_settings.file_format = "PNG"
scene.render.image_settings.color_mode = "RGBA"
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
image = bpy.data.images.load(picture)
alpha = numpy.array(image.pixels[:])[3::4]
print("covered", json.dumps(float(alpha.mean())))
