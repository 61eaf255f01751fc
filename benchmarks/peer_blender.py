"""One picture by Blender's Cycles on the processor, of a scene in glTF, for peers.py.

    python3 peer_blender.py SCENE.glb WIDTH HEIGHT SEGMENTS SAMPLES SEED OUT.npy

Needs `pip install bpy`. What Cycles does beyond following paths is off: adaptive sampling, denoising, clamped and blurred light. The
rest is Cycles' own: its light tree, its roulette. One thread, linear sRGB, a box filter.
"""
import sys
import tempfile

import bpy
import numpy as np


def shine_forwards(material):
    """A lamp of glTF that is not double-sided shines from its front; Blender's shine from both sides unless told."""
    tree = material.node_tree
    surface = next((n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"), None) if tree else None
    if surface is None or not material.use_backface_culling:
        return
    strength = surface.inputs["Emission Strength"]
    if strength.is_linked or strength.default_value == 0:
        return
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    front = tree.nodes.new("ShaderNodeMath")
    front.operation = "MULTIPLY_ADD"
    front.inputs[1].default_value, front.inputs[2].default_value = -strength.default_value, strength.default_value
    tree.links.new(geometry.outputs["Backfacing"], front.inputs[0])
    tree.links.new(front.outputs[0], strength)
    material.cycles.emission_sampling = "FRONT"


def main():
    file, width, height, segments, samples, seed, out = sys.argv[1], *map(int, sys.argv[2:7]), sys.argv[7]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    for material in bpy.data.materials:
        shine_forwards(material)
    scene = bpy.context.scene
    scene.world = None
    scene.camera = next(o for o in bpy.data.objects if o.type == "CAMERA")
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.threads_mode, render.threads = "FIXED", 1
    cycles.device, cycles.seed, cycles.samples = "CPU", seed, samples
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.light_sampling_threshold = "BOX", 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", segments - 1)
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    with tempfile.NamedTemporaryFile(suffix=".exr") as picture:
        render.filepath = picture.name
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(picture.name)
        pixels = np.array(image.pixels[:]).reshape(height, width, image.channels)
    np.save(out, pixels[::-1, :, :3])


main()
