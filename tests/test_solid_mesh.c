/* What a scene says of the mesh of a solid: sources, the keys that each takes, and its words about the rest. */
#include "base/memory.h"
#include "solid/front/mesh.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* A file of its own: a scene's mesh as the mesh of nothing else. */
typedef struct Root {
    int slender;
    SolidMeshScene mesh;
} Root;

static const YamlTable root = {
    .name = "root",
    .size = sizeof(Root),
    .doc = "",
    .fields = (const YamlField[]){{YAML_INTEGER(Root, slender), .required = true, .doc = ""},
                                  {YAML_TABLE(Root, mesh, &solid_mesh_table), .required = true, .doc = ""},
                                  {0}}};

/* The tetrahedra, or NULL and the report. */
static Tets *read_mesh(const char *mesh, int order, char *report, size_t size)
{
    Root scene;
    MeshReport warnings = {0};
    char *text = mem_format("slender: 1\nmesh: %s\n", mesh);
    YamlFile *file = yaml_parse("test.yaml", text, strlen(text));
    mem_free(text);
    Tets *tets =
        yaml_load(file, &root, &scene) ? solid_read_mesh(&scene.mesh, file, "mesh", order, &warnings) : NULL;
    text = yaml_report(file);
    snprintf(report, size, "%s", text ? text : "");
    if (tets && warnings.warning_count) snprintf(report, size, "%s", warnings.warnings[0]);
    mem_free(text);
    mesh_report_clear(&warnings);
    yaml_clear(&root, &scene);
    yaml_destroy(file);
    return tets;
}

static const struct {
    const char *mesh;
    int order, nodes, count;
} good[] = {
    {"{shape: box, size: [3 mm, 2 mm, 1 mm], cells: [3, 2, 1]}", 2, 7 * 5 * 3, 36},
    {"{shape: plate, size: [3 mm, 2 mm, 1 mm], cells: [3, 2, 1], pattern: crossed}", 1, 2 * 18, 72},
    {"{shape: hand, size: 80 mm}", 1, 558, 1248},
    {"{shape: hand, size: 80 mm}", 2, 2919, 1248},
    {"{shape: hand, size: 80 mm, n: 2, thickness: 8 mm, layers: 2}", 1, 2919, 9984},
    {"{shape: heart, size: 40 mm}", 2, 3783, 1800},
    {"{shape: starfish, size: 50 mm, n: 5}", 1, 692, 1725},
    {"{extrude: {shape: disc, size: 10 mm, n: 3}, thickness: 1 mm, layers: 2}", 1, 37 * 3, 54 * 6},
    {"{extrude: {file: test_solid_mesh.obj, scale: 1.0e-3}, thickness: 1 mm}", 1, 8, 6},
    {"{file: test_solid_mesh.msh, scale: 1.0e-3}", 2, 10, 1},
    {"test_solid_mesh.msh", 1, 4, 1},
};

static const struct {
    const char *mesh, *sentence;
} broken[] = {
    {"{shape: box, cells: [3, 2, 1]}",
     "a box needs `size`: [60 mm, 20 mm, 5 mm] of a box or plate, 80 mm of others"},
    {"{shape: box, size: [3 mm, 2 mm, 1 mm]}", "a box needs `cells`: along x, y and z, e.g. [12, 4, 1]"},
    {"{shape: box, size: 3 mm, cells: [3, 2, 1]}", "a box has three lengths: [60 mm, 20 mm, 5 mm]"},
    {"{shape: box, size: [3 mm, 2 mm, 1 mm], cells: [3, 2]}",
     "mesh.cells must be a list of 3 entries, not 2"},
    {"{shape: box, size: [3 mm, 2 mm, 1 mm], cells: [3, 2, 1], pattern: crossed}",
     "a box does not take this key; it takes size, cells"},
    {"{shape: box, size: [3 mm, 2 mm, 1 mm], cells: [3000, 3000, 3000]}",
     "162000000000 tetrahedra are too many; a generated solid has at most 20000000"},
    {"{shape: hand, size: [80 mm, 80 mm]}", "a hand has one size: 80 mm"},
    {"{shape: hand, size: 80 mm, cells: [3, 2, 1]}",
     "a hand does not take this key; it takes size, n, thickness, layers"},
    {"{shape: hand, size: 80 mm, n: 0}", "mesh.n is 0; it must be in [1, 200]"},
    {"{shape: hand, size: 80 mm, scale: 2}", "a hand does not take this key"},
    {"{shape: heart, size: 40 mm, thickness: 20 mm}",
     "a heart has a wall thinner than its radius 0.02 m, not 0.02 m"},
    {"{shape: glove, size: 80 mm}", "box, plate, hand, heart"},
    {"{extrude: {shape: disc, size: 10 mm, n: 3}}",
     "what is extruded needs `thickness`: along its normals, e.g. 2 mm"},
    {"{extrude: {shape: disc, size: 10 mm, n: 3}, thickness: 1 mm, n: 3}",
     "what is extruded does not take this key; it takes thickness, layers"},
    {"{extrude: {shape: disc, size: 10 mm}, thickness: 1 mm}", "a disc needs `n`"},
    {"{extrude: {file: test_solid_mesh.msh}, thickness: 1 mm}", "a tetrahedron in a mesh of triangles"},
    {"{file: test_solid_mesh.obj}", "there are no tetrahedra in it; a solid is made of them"},
    {"{file: test_solid_mesh.msh, size: 3 mm}", "a mesh from a file does not take this key; it takes scale"},
    {"{file: none.msh}", "none.msh"},
    {"{surface: test_solid_mesh.obj}", "a surface that is filled needs `size`"},
    {"{surface: test_solid_mesh.obj, size: 1 mm}", "the surface is open at its edge from vertex 0 to 1"},
    {"{surface: test_solid_mesh.msh, size: 1 mm}", "a tetrahedron in a mesh of triangles"},
    {"{surface: test_solid_mesh.obj, shape: box}",
     "mesh has shape and surface; give only one of file, shape, extrude, surface"},
};

static void save(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    fputs(text, out);
    fclose(out);
}

static void test_good(void **state)
{
    (void)state;
    char report[4096];
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        Tets *tets = read_mesh(good[k].mesh, good[k].order, report, sizeof report);
        if (!tets || report[0]) fail_msg("%s: %s", good[k].mesh, report);
        if (tets_node_count(tets) != good[k].nodes || tets->count != good[k].count)
            fail_msg("%s: %d nodes, %d tetrahedra", good[k].mesh, tets_node_count(tets), tets->count);
        tets_destroy(tets);
    }
}

static void test_broken(void **state)
{
    (void)state;
    char report[4096];
    for (size_t k = 0; k < sizeof broken / sizeof *broken; k++) {
        long blocks = mem_live_count();
        assert_null(read_mesh(broken[k].mesh, TET_QUADRATIC, report, sizeof report));
        if (!strstr(report, broken[k].sentence)) fail_msg("%s says\n%s", broken[k].mesh, report);
        assert_int_equal(mem_live_count(), blocks);
    }
}

/* What is wrong with a sheet that is made thick is not lost. */
static void test_warning(void **state)
{
    (void)state;
    char report[4096];
    save("test_solid_mesh.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 1 3 4\n");
    Tets *tets = read_mesh("{extrude: test_solid_mesh.obj, thickness: 1 mm}", 1, report, sizeof report);
    assert_non_null(tets);
    assert_non_null(strstr(report, "test_solid_mesh.obj:5: 1 vertex was removed, being in no face"));
    tets_destroy(tets);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_good), cmocka_unit_test(test_broken),
                                       cmocka_unit_test(test_warning)};
    save("test_solid_mesh.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    save("test_solid_mesh.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
         "$EndNodes\n$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n");
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink("test_solid_mesh.obj");
    unlink("test_solid_mesh.msh");
    return failed;
}
