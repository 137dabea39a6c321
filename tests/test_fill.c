/* Surfaces that another program fills: what it is given, and what becomes of what it says. The program is one that stands in
 * for tetgen. */
#include "base/memory.h"
#include "solid/fill.h"
#include "solid/tets.h"
#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

/* A cube of 2, and its top a group of two faces. */
static const char cube[] =
    "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 2 2 0\nv 0 0 2\nv 2 0 2\nv 0 2 2\nv 2 2 2\n"
    "f 1 3 4\nf 1 4 2\nf 1 2 6\nf 1 6 5\nf 1 5 7\nf 1 7 3\nf 8 4 3\nf 8 3 7\nf 8 6 2\nf 8 2 4\n"
    "g lid\nf 8 7 5\nf 8 5 6\n";

/* In units of 0.5, with a node in the middle. */
#define NODES                                                                                                \
    "9 3 0 0\\n0 0 0 0\\n1 4 0 0\\n2 0 4 0\\n3 4 4 0\\n4 0 0 4\\n5 4 0 4\\n6 0 4 4\\n7 4 4 4\\n8 2 2 2\\n# " \
    "by hand\\n"
#define CELLS                                                                                                \
    "12 4 0\\n0 0 2 3 8\\n1 0 3 1 8\\n2 0 1 5 8\\n3 0 5 4 8\\n4 0 4 6 8\\n5 0 6 2 8\\n6 7 3 2 8\\n7 7 2 6 "  \
    "8\\n"                                                                                                   \
    "8 7 5 1 8\\n9 7 1 3 8\\n10 7 6 4 8\\n11 7 4 5 8\\n"
#define GOOD "printf '" NODES "' > $stem.1.node\nprintf '" CELLS "' > $stem.1.ele\n"

static char folder[] = "test_fill_XXXXXX";

/* The words of a script that stands in for tetgen; NULL: there is none. */
static void stand_in(const char *script)
{
    char path[200];
    snprintf(path, sizeof path, "%s/tetgen", folder);
    unlink(path);
    if (!script) return;
    FILE *file = fopen(path, "w");
    fprintf(file,
            "#!/bin/sh\necho \"$1 $#\" > \"$TEST_SAID\"\n/bin/cat \"$2\" >> "
            "\"$TEST_SAID\"\nstem=${2%%.smesh}\n%s",
            script);
    fclose(file);
    chmod(path, 0755);
}

static Mesh *surface_of(const char *obj)
{
    MeshFile file;
    Error err;
    if (!mesh_file_parse("cube", "obj", obj, (long)strlen(obj), &file, &err)) fail_msg("%s", err.text);
    Mesh *mesh = mesh_create(&file, 0, NULL, &err);
    mesh_file_clear(&file);
    return mesh;
}

/* No folder of a run is left in $TMPDIR. */
static void check_tidy(void)
{
    DIR *files = opendir(folder);
    for (struct dirent *file; (file = readdir(files));)
        if (!strncmp(file->d_name, "slender-", 8)) fail_msg("%s is left", file->d_name);
    closedir(files);
}

static void test_good(void **state)
{
    (void)state;
    Error err;
    MeshFile mesh;
    Mesh *surface = surface_of(cube);
    stand_in(GOOD);
    if (!solid_fill(surface, 0.5, &mesh, &err)) fail_msg("%s", err.text);
    Tets *tets = tets_create(&mesh, TET_QUADRATIC, NULL, &err);
    assert_int_equal(tets->count, 12);
    double volume = 0;
    for (int t = 0; t < 12; t++) volume += tets->volume[t];
    assert_true(fabs(volume - 8) < 1e-14);
    assert_memory_equal(tets->surface->rest, surface->rest, 8 * sizeof *surface->rest);
    assert_true(tets->surface->rest[8][0] == 1 && tets->surface->rest[8][2] == 1);
    for (int g = 0; g < tets->surface->group_count; g++)
        if (tets->surface->groups[g].dim == 2)
            assert_memory_equal(tets->surface->groups[g].members, ((int[]){10, 11}), 8);
    char said[2000];
    FILE *file = fopen("test_fill_said", "r");
    said[fread(said, 1, sizeof said - 1, file)] = 0;
    fclose(file);
    assert_non_null(strstr(said, "-pYq1.4a0.118zQ 2\n8 3 0 0\n0 0 0 0\n1 4 0 0\n"));
    assert_non_null(strstr(said, "\n12 0\n3 0 2 3\n"));
    assert_non_null(strstr(said, "3 7 4 5\n0\n0\n"));
    tets_destroy(tets);
    mesh_file_clear(&mesh);
    mesh_destroy(surface);
    check_tidy();
}

static const struct {
    const char *script, *sentence;
} failures[] = {
    {NULL, "the program tetgen is not installed (not in PATH): Debian has it as tetgen; or fill the surface "
           "with gmsh and "
           "give its .msh as `file`"},
    {"echo begins\necho 'Error:  two facets intersect.' >&2\nexit 3\n",
     "the program tetgen ended with code 3: Error:  two facets intersect."},
    {"exit 127\n", "the program tetgen is not installed (not in PATH)"},
    {"exit 1\n", "the program tetgen ended with code 1"},
    {"kill -9 $$\n", "the program tetgen was ended by signal 9"},
    {"true\n", "surface.1.node: "},
    {"printf '9 3 0 0\\n0 0 0 0\\n1 4 0\\n' > $stem.1.node\n", "surface.1.node:3: a coordinate is missing"},
    {"printf '9 3 0 0\\n0 0 0 0\\n' > $stem.1.node\n", "surface.1.node:2: the file ends before its last row"},
    {"printf '" NODES "' > $stem.1.node\nprintf '1 4 0\\n0 0 1 2 9\\n' > $stem.1.ele\n",
     "surface.1.ele:2:9: "},
    {"printf '4 3 0 0\\n0 0 0 0\\n1 1 0 0\\n2 0 1 0\\n3 0 0 1\\n' > $stem.1.node\n"
     "printf '1 4 0\\n0 0 1 2 3\\n' > $stem.1.ele\n",
     "tetgen has changed the surface, which it was told to keep"},
    {"printf '" NODES "' > $stem.1.node\nprintf '" CELLS "' | /bin/sed 's/^12 4/11 4/' > $stem.1.ele\n",
     "the surface has 12 faces, and what tetgen made of it 14"},
};

static void test_failures(void **state)
{
    (void)state;
    Mesh *surface = surface_of(cube);
    for (size_t k = 0; k < sizeof failures / sizeof *failures; k++) {
        Error err;
        MeshFile mesh;
        long blocks = mem_live_count();
        stand_in(failures[k].script);
        assert_false(solid_fill(surface, 0.5, &mesh, &err));
        if (!strstr(err.text, failures[k].sentence))
            fail_msg("%s\nlacks\n%s", err.text, failures[k].sentence);
        assert_int_equal(mem_live_count(), blocks);
        check_tidy();
    }
    mesh_destroy(surface);
}

static void test_open(void **state)
{
    (void)state;
    Error err;
    MeshFile mesh;
    Mesh *surface = surface_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_false(solid_fill(surface, 1, &mesh, &err));
    assert_string_equal(
        err.text, "the surface is open at its edge from vertex 0 to 1; only a closed one can be filled");
    mesh_destroy(surface);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_good), cmocka_unit_test(test_failures),
                                       cmocka_unit_test(test_open)};
    if (!mkdtemp(folder)) return 1;
    setenv("PATH", folder, 1); /* where another tetgen cannot be */
    setenv("TMPDIR", folder, 1);
    setenv("TEST_SAID", "test_fill_said", 1);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    stand_in(NULL);
    unlink("test_fill_said");
    rmdir(folder);
    return failed;
}
