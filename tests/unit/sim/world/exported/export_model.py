"""One textured model in seven formats, by Blender and by assimp's exporter: the files beside this one, anew.

blender -b --factory-startup --python export_model.py     # Debian: blender, assimp-utils
"""
import math
import os
import random
import shutil
import subprocess

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
MADE = '/tmp/exported_model'  # exporters write whole paths: these name no folder of anybody


def picture(size=64):
    """Smooth colours without a symmetry, between 40 and 215 of 255."""
    wave = random.Random(1)
    terms = [[(wave.uniform(-3, 3), wave.uniform(-3, 3), wave.uniform(0, 6)) for _ in range(4)] for _ in range(3)]
    image = bpy.data.images.new('paint', size, size)
    values = []
    for row in range(size):
        for column in range(size):
            x, y = (column + 0.5) / size, (row + 0.5) / size
            for colour in terms:
                values.append(0.5 + 0.085 * sum(math.sin(2 * a * x + 2 * b * y + c) for a, b, c in colour))
            values.append(1)
    image.pixels = values
    image.filepath_raw, image.file_format = '//paint.png', 'PNG'
    image.save()
    return image


def model():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath('blender/model.blend'))  # '//' is its folder
    bpy.ops.mesh.primitive_torus_add(major_segments=8, minor_segments=5, major_radius=0.5, minor_radius=0.22)
    ring = bpy.context.object
    for vertex in ring.data.vertices:  # no symmetry
        vertex.co.x += 0.3 * vertex.co.y * vertex.co.z
        vertex.co.z *= 1 + 0.4 * vertex.co.x
    for loop in ring.data.uv_layers[0].data:
        loop.uv = 0.05 + 0.9 * loop.uv[0], 0.05 + 0.9 * loop.uv[1]
    for polygon in ring.data.polygons:
        polygon.use_smooth = True
    bpy.ops.object.modifier_add(type='TRIANGULATE')  # exporters divide quadrangles in ways of their own
    bpy.ops.object.modifier_apply(modifier='Triangulate')
    ring.location, ring.rotation_euler, ring.scale = (0.3, -0.2, 0.9), (0.4, 0.2, 0.7), (1.2, 0.8, 1.1)
    material = bpy.data.materials.new('paint')
    material.use_nodes = True
    texture = material.node_tree.nodes.new('ShaderNodeTexImage')
    texture.image = picture()
    surface = material.node_tree.nodes['Principled BSDF']
    material.node_tree.links.new(texture.outputs['Color'], surface.inputs['Base Color'])
    ring.data.materials.append(material)


def insert(path, before, line):
    with open(path) as file:
        text = file.read()
    with open(path, 'w') as file:
        file.write(text.replace(before, line + before, 1))


for program in 'blender', 'assimp':
    os.makedirs(os.path.join(MADE, program))
os.chdir(MADE)
model()
name = 'blender/model'
bpy.ops.export_scene.gltf(filepath=name + '.gltf', export_format='GLTF_EMBEDDED')
bpy.ops.export_scene.gltf(filepath=name + '.glb', export_format='GLB')
bpy.ops.wm.obj_export(filepath=name + '.obj', path_mode='RELATIVE')
bpy.ops.export_mesh.ply(filepath=name + '.ply', axis_forward='-Z', axis_up='Y', use_ascii=True, use_colors=False)
bpy.ops.wm.collada_export(filepath=name + '.dae', use_texture_copies=False)
bpy.ops.export_scene.fbx(filepath=name + '.fbx', path_mode='RELATIVE')
insert(name + '.ply', 'comment Created', 'comment TextureFile paint.png\n')
os.remove(name + '.blend')
# The OBJ of a material without a colour: assimp's reader puts 0.6 there, so its exporter is given 1.
with open(name + '.mtl') as file:
    colourless = file.read()
insert(name + '.mtl', 'map_Kd', 'Kd 1 1 1\n')
for extension, kind in [('gltf', 'gltf2'), ('glb', 'glb2'), ('obj', 'obj'), ('ply', 'ply'), ('dae', 'collada'),
                        ('fbx', 'fbx'), ('ascii.fbx', 'fbxa')]:
    subprocess.run(['assimp', 'export', name + '.obj', 'assimp/model.' + extension, '-f' + kind], check=True)
with open(name + '.mtl', 'w') as file:
    file.write(colourless)
shutil.copy('blender/paint.png', 'assimp')
shutil.copytree(MADE, HERE, dirs_exist_ok=True)
shutil.rmtree(MADE)
