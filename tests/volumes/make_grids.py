# Writes three.vdb, by OpenVDB (Debian's python3-openvdb), of which nanovdb_convert (libnanovdb-tools, 10.0.1) made the files here:
#     nanovdb_convert --zip three.vdb three_grids.nvdb
#     nanovdb_convert --zip -g density --fp4 three.vdb rounded_fp4.nvdb       (and fp8, fp16, fpN)
#     nanovdb_convert --blosc -g temperature three.vdb blosc.nvdb
# What is in them is what nanovdb_test.cpp expects. Tests need the files alone.
import pyopenvdb as vdb

density = vdb.FloatGrid()
density.name = "density"
density.gridClass = vdb.GridClass.FOG_VOLUME
density.transform = vdb.createLinearTransform([[0.5, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, 0.5, 0], [1, 2, 3, 1]])
cells = density.getAccessor()
for i in range(-3, 12):
    for j in range(5, 9):
        for k in range(0, 3):
            cells.setValueOn((i, j, k), 100 + 0.25 * i + j + 16 * k)
density.fill((16, 0, 0), (23, 7, 7), 7.5)

temperature = vdb.FloatGrid()
temperature.name = "temperature"
temperature.transform = vdb.createLinearTransform(0.25)
cells = temperature.getAccessor()
for i in range(4):
    cells.setValueOn((i, 1, 2), 1000.0 + i)

color = vdb.Vec3SGrid()
color.name = "color"
color.transform = vdb.createLinearTransform(1)
cells = color.getAccessor()
cells.setValueOn((0, 0, 0), (0.25, 0.5, 0.75))
cells.setValueOn((1, 0, 0), (1, 2, 3))

vdb.write("three.vdb", [density, temperature, color])
