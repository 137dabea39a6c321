/* Strands of points from CSV, OBJ and SVG: what is in them, and what is refused with which sentence. */
#include "base/memory.h"
#include "io/polyline_file.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static PolylineFile parse(const char *format, const char *text)
{
    PolylineFile file;
    Error err = {""};
    if (!polyline_file_parse("a", format, text, (long)strlen(text), &file, &err)) fail_msg("%s", err.text);
    return file;
}

static void check_refused(const char *format, const char *text, const char *sentence)
{
    PolylineFile file;
    Error err = {""};
    assert_false(polyline_file_parse("a", format, text, (long)strlen(text), &file, &err));
    assert_string_equal(err.text, sentence);
    assert_true(!file.points && !file.first && file.strand_count == 0);
}

/* Strand k has these coordinates, in millimetres if scale is 1e-3. */
static void check_strand(const PolylineFile *file, int k, double scale, int count, const double (*x)[3])
{
    assert_int_equal(file->first[k + 1] - file->first[k], count);
    for (int i = 0; i < count; i++) {
        Vec3 off = vec3_sub(file->points[file->first[k] + i], vec3_scale(scale, vec3_load(x[i])));
        if (!(vec3_length(off) < 1e-14)) fail_msg("point %d of strand %d is off", i, k);
    }
}

static void test_csv(void **state)
{
    (void)state;
    const double x[3][3] = {{0, 0, 0}, {1, 2.5, -3}, {2, 0, 1e-3}};
    PolylineFile file = parse("csv", "# a rod\nx, y, z\n0, 0, 0\n1, 2.5, -3 # a comment\n\n2, 0, 1e-3\n");
    assert_int_equal(file.strand_count, 1);
    check_strand(&file, 0, 1, 3, x);
    polyline_file_clear(&file);
    file = parse("CSV", "3 0 0 0\n7.1 1 2.5 -3\n11.9 2 0 1e-3");
    check_strand(&file, 0, 1, 3, x);
    polyline_file_clear(&file);
    file = parse("csv", "0, 1, 0, 0\n1.5707963, 0, 1, 0\n3.1415927, -1, 0, 0\n"); /* half a circle */
    assert_int_equal(file.point_count, 3);
    polyline_file_clear(&file);
    file = parse("csv", "x [mm], y/mm, z mm\n0, 0, 0\n1, 2.5, -3\n2, 0, 1e-3\n");
    check_strand(&file, 0, 1e-3, 3, x);
    assert_true(file.scaled);
    polyline_file_clear(&file);
    check_refused("csv", "", "a: there are no numbers in it");
    check_refused("csv", "1,2,3\n", "a: there are no lines in it");
    check_refused("csv", "# x, y\n1, 2\n2, 3\n",
                  "a:2: 2 numbers in this row; it must be x, y, z or s, x, y, z");
    check_refused("csv", "1,2,3\n1,2,nan\n", "a:2: 'nan' is no finite number");
    check_refused("csv", "1,2,3\n1,2\n", "a:2: 2 numbers in this row, and 3 are needed");
    check_refused("csv", "x,y,z,r\n1,2,3,4\n",
                  "a:1: column 1 is headed 'x'; the columns must be s [m], x [m], y [m], z [m]");
    check_refused("csv", "5,0;-3,0\n7,5;-3,0\n",
                  "a:1: 2 numbers in this row; it must be x, y, z or s, x, y, z");
    check_refused("csv", "0,0,0,0\n1,1,0,0\n1,2,0,0\n",
                  "a:3: s is 1 here and 1 in the row before: it must increase");
    check_refused("csv", "0,0,0,0\n1000,1,0,0\n2000,2,0,0\n",
                  "a:3: s grows by 2000 to here, and the points are 2 apart along the curve: s must be their "
                  "arclength, in "
                  "the unit of x, y, z");
    check_refused("csv", "0,0,0,0\n1,1,0,0\n1.9,2,0,0\n",
                  "a:3: s grows by 1.9 to here, and the points are 2 apart along the curve: s must be their "
                  "arclength, in "
                  "the unit of x, y, z");
}

static void test_obj(void **state)
{
    (void)state;
    const double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 5, 6}};
    const char *vertices = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\n";
    char *text = mem_format("%s# lines\nl 1 2 3\nl -1 -2\nv 4 5 6\n", vertices);
    PolylineFile file = parse("obj", text);
    assert_int_equal(file.strand_count, 1);
    check_strand(&file, 0, 1, 4, x);
    polyline_file_clear(&file);
    mem_free(text);

    /* Edges in any order and direction, vertices last; a ring; lines of many vertices from one place. */
    static const struct {
        const char *lines;
        int strands, count[2], vertex[2][5], line[2];
    } joins[] = {
        {"l 1 2\nl 2 3/7\nl 3 4\n", 1, {4}, {{0, 1, 2, 3}}, {1}},
        {"l 3 4\n\nl 1 2\nl 2 \\\n3\n", 1, {4}, {{0, 1, 2, 3}}, {1}},
        {"l 2 1\nl 3 4\nl 2 3\nl 4 5", 1, {5}, {{0, 1, 2, 3, 4}}, {1}},
        {"l 2 1\nl 4 3\nl 3 2\nl 4 5", 1, {5}, {{4, 3, 2, 1, 0}}, {1}},
        {"l 2 3\nl 1 2\nl 4 1\nl 3 4", 1, {5}, {{1, 2, 3, 0, 1}}, {1}},
        {"l 5 4 3\nl 3 2 1\n", 1, {5}, {{4, 3, 2, 1, 0}}, {1}},
        {"\nl 1 2 3\nl 1 4 5\n", 2, {3, 3}, {{0, 1, 2}, {0, 3, 4}}, {2, 3}},
        {"l 4 5\nl 1 2\nl 2 3\n", 2, {2, 3}, {{3, 4}, {0, 1, 2}}, {1, 2}},
        {"l 1 2 3 1\nl 5 4", 2, {4, 2}, {{0, 1, 2, 0}, {4, 3}}, {1, 2}},
    };
    for (size_t k = 0; k < sizeof joins / sizeof *joins; k++) {
        text = mem_format("%s\n%sv 4 5 6\n", joins[k].lines, vertices);
        file = parse("obj", text);
        assert_int_equal(file.strand_count, joins[k].strands);
        for (int i = 0; i < joins[k].strands; i++) {
            double places[5][3];
            for (int j = 0; j < 5; j++) memcpy(places[j], x[joins[k].vertex[i][j]], sizeof places[j]);
            check_strand(&file, i, 1, joins[k].count[i], (const double(*)[3])places);
            assert_int_equal(file.line[i], joins[k].line[i]);
        }
        polyline_file_clear(&file);
        mem_free(text);
    }

    text = mem_format("o strand\n%sv 4 5 6 1.0\n", vertices);
    file = parse("obj", text);
    assert_int_equal(file.strand_count, 1);
    check_strand(&file, 0, 1, 5, x);
    polyline_file_clear(&file);
    mem_free(text);

    check_refused("obj", "", "a: there are no lines in it");
    check_refused("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a: there are faces in it and no lines");
    check_refused("obj", "v 0 0 0\nl 1 2\n", "a:2: vertex 2 does not exist: there are 1");
    check_refused("obj", "v 0 0 0\nl 1\n", "a:2: a line needs two vertices at least");
    static const char *const branches[][2] = {
        {"l 1 2\nl 2 3\nl 4 2\n", "a:1: more than two lines meet at vertex 2: a rod has no branches"},
        {"l 1 2 3\nl 4 2\n", "a:2: more than two lines meet at vertex 2: a rod has no branches"},
        {"l 1 2\nl 2 1\n", "a:1: the edge from vertex 1 is there twice"},
        {"l 1 1\n", "a:1: the line goes from vertex 1 to the same"}};
    for (size_t k = 0; k < sizeof branches / sizeof *branches; k++) {
        text = mem_format("%s%s", branches[k][0], vertices);
        check_refused("obj", text, branches[k][1]);
        mem_free(text);
    }
    check_refused("obj", "v 0 0\nl 1 2\n", "a:1: a coordinate is missing");
    check_refused("obj", "v 0 0 0\nl 1 -2\n", "a:2:5: vertex -2 is before the first one: there are 1 so far");
    check_refused("obj", "v 0 0 0\nl 1 x\n",
                  "a:2:5: 'x' is no vertex: they count from 1, or from -1 backwards");
}

/* A page of a square decimetre whose unit is a millimetre. */
static PolylineFile draw(const char *elements)
{
    char *text = mem_format("<?xml version='1.0'?>\n<svg xmlns='http://www.w3.org/2000/svg' width='100mm' "
                            "height='10cm' viewBox='0 0 100 100'>\n%s\n</svg>",
                            elements);
    PolylineFile file = parse("svg", text);
    mem_free(text);
    return file;
}

static void test_svg_lines(void **state)
{
    (void)state;
    const double x[4][3] = {{10, -10, 0}, {20, -10, 0}, {20, -30, 0}, {10, -10, 0}};
    PolylineFile file = draw("<path d='M10 10L20,10 20 30z m 1 1 h-2.5.5 V5-6'/>");
    assert_int_equal(file.strand_count, 2);
    check_strand(&file, 0, 1e-3, 4, x);
    check_strand(&file, 1, 1e-3, 5,
                 (const double[5][3]){{11, -11, 0}, {8.5, -11, 0}, {9, -11, 0}, {9, -5, 0}, {9, 6, 0}});
    polyline_file_clear(&file);
    file = draw("<polyline points='10 10 20,10 20 30'/><polygon points='10,10,20,10,20,30'/>\n"
                "<line x1='10' y1='10' x2='20' y2='10'/><path d='M 1 1'/><path/><rect width='5'/><circle/>"
                "<path d='m10 10 10 0 0 20Zl10 0'/><svg:path xmlns:svg='s' d='M10 10h10'/>");
    assert_int_equal(file.strand_count, 6);
    check_strand(&file, 0, 1e-3, 3, x);
    check_strand(&file, 1, 1e-3, 4, x);
    check_strand(&file, 2, 1e-3, 2, x);
    check_strand(&file, 3, 1e-3, 4, x);
    check_strand(&file, 4, 1e-3, 2, x); /* after Z, from the subpath's first point */
    check_strand(&file, 5, 1e-3, 2, x);
    polyline_file_clear(&file);
}

static void check_same(const char *one, const char *other)
{
    PolylineFile a = draw(one), b = draw(other);
    assert_int_equal(a.point_count, b.point_count);
    assert_int_equal(a.strand_count, b.strand_count);
    for (int i = 0; i < a.point_count; i++)
        if (!(vec3_length(vec3_sub(a.points[i], b.points[i])) < 1e-15))
            fail_msg("%s\n%s\npoint %d", one, other, i);
    polyline_file_clear(&a);
    polyline_file_clear(&b);
}

static void test_svg_curves(void **state)
{
    (void)state;
    PolylineFile file = draw("<path d='M10 20C10 60 40 60 40 20'/>");
    assert_int_equal(file.point_count, 513);
    for (int i = 0; i <= 512; i++) {
        double t = i / 512., s = 1 - t;
        Vec3 x = vec3(1e-3 * (10 * (s * s * s + 3 * s * s * t) + 40 * (3 * s * t * t + t * t * t)),
                      -1e-3 * (20 * (s * s * s + t * t * t) + 60 * 3 * s * t), 0);
        assert_true(vec3_length(vec3_sub(file.points[i], x)) < 1e-16);
    }
    polyline_file_clear(&file);

    /* A circle of 10 mm in two arcs, the long way and the short way round. */
    file = draw("<path d='M60 50A10 10 0 1 1 50 40 10 10 0 0160 50'/>");
    double worst = 0, length = 0;
    for (int i = 0; i < file.point_count; i++) {
        worst = fmax(worst, fabs(hypot(file.points[i].x - 0.05, file.points[i].y + 0.05) - 0.01));
        if (i > 0) length += vec3_length(vec3_sub(file.points[i], file.points[i - 1]));
    }
    print_message("a circle of 10 mm by arcs: %d points, off by %.1e m, %.8f m long\n", file.point_count,
                  worst, length);
    assert_true(worst < 1e-9 && fabs(length / (2 * M_PI * 0.01) - 1) < 1e-4 && file.point_count > 512);
    polyline_file_clear(&file);

    /* An ellipse's quarter, turned by 30 degrees; radii that are too small grow. */
    file = draw("<path d='M20 0A20 10 0 0 1 0 10' transform='rotate(30)'/>");
    for (int i = 0; i < file.point_count; i++) {
        double c = cos(M_PI / 6), s = 0.5, x = file.points[i].x, y = -file.points[i].y;
        assert_true(fabs(hypot((c * x + s * y) / 0.02, (c * y - s * x) / 0.01) - 1) < 1e-7);
    }
    polyline_file_clear(&file);
    check_same("<path d='M20 0A1 1 0 0 1 0 0'/>", "<path d='M20 0A10 10 0 0 1 0 0'/>");
    check_same("<path d='M5 5A0 9 0 0 1 15 5'/>", "<path d='M5 5H15'/>");

    check_same("<path d='M1 1q2 3 4 0t4 0'/>", "<path d='M1 1Q3 4 5 1 Q7-2 9 1'/>");
    check_same("<path d='M1 1c1 2 3 2 4 0s3-2 4 0'/>", "<path d='M1 1C2 3 4 3 5 1C6-1 8-1 9 1'/>");
    check_same("<path d='M1 1S3 3 5 1t4 0l1 1T3 3'/>", "<path d='M1 1C1 1 3 3 5 1Q5 1 9 1L10 2Q10 2 3 3'/>");
    check_same("<path d='M1 1a5 3 20 10 9 2'/>", "<path d='M1 1A5 3 20 1 0 10 3'/>");
}

static void test_svg_places(void **state)
{
    (void)state;
    const double x[2][3] = {{10, -10, 0}, {20, -10, 0}};
    check_same("<g transform='translate(10,10)'><g transform='scale(2)'><path d='M0 0h5'/></g></g>",
               "<path d='M10 10h10'/>");
    check_same(
        "<path transform='translate(3) rotate(90 4 5) skewX(45),scale(1,2)' d='M1 1h1v1'/>",
        "<path transform='matrix(1 0 0 1 3 0) matrix(0 1 -1 0 9 1) matrix(1 0 1 1 0 0) matrix(1 0 0 2 0 0)' "
        "d='M1 1h1v1'/>");
    PolylineFile file = draw("<defs><path d='M0 0h1'/></defs><g display='none'><g><path d='M0 0h1'/></g></g>"
                             "<path style='fill:none;display:none' d='M0 0h1'/><path d='M10 10h10'/>"
                             "<clipPath><path d='M0 0h1'/></clipPath>");
    assert_int_equal(file.strand_count, 1);
    check_strand(&file, 0, 1e-3, 2, x);
    polyline_file_clear(&file);
    static const char *const pages[] = {
        "<svg><path d='M37.795275590551178 37.795275590551178h37.795275590551178'/></svg>", /* 1/96 inch */
        "<svg width='100%' height='50%'><path transform='scale(3.7795275590551178)' d='M10 10h10'/></svg>",
        "<svg width='50mm' viewBox='-5 -5 25 1'><path d='M0 0h5'/></svg>",
        "<svg width='1in' height='1in' viewBox='0 0 25.4 12.7'><path d='M10 3.65h10'/></svg>",
        "<svg width='72pt' height='6pc' viewBox='0 0 25.4 25.4'><path d='M10 10h10'/></svg>",
        "<svg width='100mm' height='50mm' viewBox='0 0 100 100'><path d='M-30 20h20'/></svg>",
        "<svg width='100mm' height='50mm' viewBox='0 0 100 100' preserveAspectRatio='none'>"
        "<path d='M10 20h10'/></svg>",
        "<svg width='100mm' height='50mm' viewBox='0 0 100 100' preserveAspectRatio='xMidYMid slice'>"
        "<path d='M10 35h10'/></svg>",
        "<svg width='100mm' height='50mm' viewBox='0 0 100 100' preserveAspectRatio='xMaxYMid'>"
        "<path d='M-80 20h20'/></svg>"};
    for (size_t k = 0; k < sizeof pages / sizeof *pages; k++) {
        file = parse("svg", pages[k]);
        check_strand(&file, 0, 1e-3, 2, x);
        polyline_file_clear(&file);
    }
}

static void test_svg_shapes(void **state)
{
    (void)state;
    check_same("<rect x='5' y='6' width='20' height='10'/>", "<path d='M5 6H25V16H5Z'/>");
    check_same("<rect x='5' y='6' width='20' height='10' rx='3'/>",
               "<rect x='5' y='6' width='20' height='10' ry='3'/>");
    check_same(
        "<rect x='5' y='6' width='20' height='10' rx='30' ry='2'/>",
        "<path d='M15 6H15A10 2 0 0 1 25 8V14A10 2 0 0 1 15 16H15A10 2 0 0 1 5 14V8A10 2 0 0 1 15 6Z'/>");
    check_same("<ellipse cx='50' cy='40' rx='20' ry='10'/>",
               "<path d='M70 40A20 10 0 0 1 30 40A20 10 0 0 1 70 40'/>");
    check_same("<circle cx='50' cy='40' r='20'/>", "<ellipse cx='50%' cy='40%' rx='20'/>");
    check_same("<line x1='10%' y1='20%' x2='30' y2='2in'/>", "<path d='M10 20L30 192'/>");
    check_same("<line x2='10px' y2='25.4mm'/>", "<path d='M0 0L10 96'/>");
    PolylineFile file = draw("<circle cx='50' cy='40' r='20'/>");
    for (int k = 0; k < file.point_count; k++)
        assert_true(fabs(hypot(file.points[k].x - 0.05, file.points[k].y + 0.04) - 0.02) < 2e-9);
    assert_true(vec3_length(vec3_sub(file.points[0], file.points[file.point_count - 1])) < 1e-15);
    assert_int_equal(file.line[0], 3);
    polyline_file_clear(&file);
}

static void test_svg_clones(void **state)
{
    (void)state;
    check_same("<path id='p' d='M1 2h3'/><use href='#p' y='20' transform='scale(2)'/>",
               "<path d='M1 2h3'/><path d='M2 44h6'/>");
    check_same(
        "<use xlink:href='#g' x='5' xmlns:xlink='x'/><defs><g id='g'><path d='M1 2h3'/><use href='#c'/></g>"
        "<line id='c' x2='4'/></defs>",
        "<path d='M6 2h3'/><path d='M5 0h4'/>");
    check_same("<symbol id='s' viewBox='0 0 10 5'><path d='M0 0L10 5'/></symbol><use href='#s' x='1' y='2' "
               "width='20' "
               "height='20'/>",
               "<path d='M1 7L21 17'/>");
    check_same("<svg x='10' y='20' width='40' height='20' viewBox='1 1 10 10'><path d='M1 1L11 11'/></svg>",
               "<path d='M20 20L40 40'/>");
    check_same("<svg x='10' width='40' height='20' viewBox='0 0 10 10' preserveAspectRatio='xMaxYMid slice'>"
               "<path d='M0 0L10 10'/></svg>",
               "<path d='M10 -10L50 30'/>");
    check_same("<svg width='50%' height='20' viewBox='0 0 10 10' preserveAspectRatio='none'>"
               "<line x2='100%' y2='100%'/></svg>",
               "<path d='M0 0L50 20'/>");
    check_same("<svg x='3'><line x2='50%'/></svg>", "<path d='M3 0h50'/>");
    check_same(
        "<switch><path requiredExtensions='x' d='M9 9h9'/><path d='M1 2h3'/><path d='M5 5h5'/></switch>",
        "<path d='M1 2h3'/>");
}

static void test_svg_styles(void **state)
{
    (void)state;
    const char *shown = "<path d='M1 2h3'/>";
    static const char *const hidden[] = {
        "<style>.h{display:none}</style><path class='x h' d='M5 5h5'/>",
        "<style><![CDATA[ /* .h {} */ g, #a.b , path.c{fill:red;display : none !important} ]]></style>"
        "<g><path d='M5 5h5'/></g><path id='a' class='b' d='M5 5h5'/><path class='c' d='M5 5h5'/>",
        "<path display='none' visibility='visible' d='M5 5h5'/>",
        "<path display='inline' style='display:none' d='M5 5h5'/>",
        "<g visibility='hidden'><path d='M5 5h5'/></g>",
        "<style>*{visibility:hidden} .v{visibility:visible}</style><path id='i' d='M5 5h5'/><path class='v' "
        "d='M5 5' />",
        "<style>#a{display:none} .a{display:inline}</style><path id='a' class='a' d='M5 5h5'/>",
        "<style>@font-face{src:x}</style><text visibility='collapse'>a</text><text style='display:none'/>",
        "<defs><text>a</text></defs><title>a</title><metadata><x:y xmlns:x='x'>b</x:y></metadata>",
    };
    for (size_t k = 0; k < sizeof hidden / sizeof *hidden; k++) {
        char *text = mem_format("%s<path style='visibility:visible;display:inline' d='M1 2h3'/>", hidden[k]);
        check_same(text, shown);
        mem_free(text);
    }
    check_same("<g visibility='hidden'><path d='M5 5h5'/><path visibility='visible' d='M1 2h3'/></g>", shown);
    check_same("<style>path{display:none} .a{display:inline}</style><path class='a' d='M1 2h3'/>", shown);
    check_same("<path style='transform: translate(-4px, 2px) scaleX(0.5) rotate(0deg)' transform='scale(9)' "
               "d='M10 0h6'/>",
               shown);
    check_same("<style>.m{transform:translateX(1px) translateY(2px)}</style><path class='m' d='M0 0h3'/>",
               shown);
    check_same("<path style='transform:none' d='M1 2h3'/>", shown);
}

static void test_svg_refused(void **state)
{
    (void)state;
    check_refused("svg", "", "a:1: no element found");
    check_refused("svg", "<svg>\n<g>\n</svg>", "a:3: mismatched tag");
    check_refused("svg", "\n<html/>", "a:2: this is no SVG: it begins with 'html'");
    check_refused("svg", "<svg/>", "a: there are no lines in it");
    check_refused("svg", "<svg>\n<path\nd='L1 1'/></svg>",
                  "a:2: the path's data is wrong at character 1, 'L1 1'");
    check_refused("svg", "<svg><path d='M1 1 L2'/></svg>", "a:1: the path's data ends too early");
    check_refused("svg", "<svg><path d='M1 1 L2 2 3 x'/></svg>",
                  "a:1: the path's data is wrong at character 13, 'x'");
    check_refused("svg", "<svg><path d='M1 1z1 1'/></svg>",
                  "a:1: the path's data is wrong at character 6, '1 1'");
    check_refused("svg", "<svg><path d='M1 1a1 1 0 2 0 3 3'/></svg>",
                  "a:1: the path's data is wrong at character 12, '2 0 3 3'");
    check_refused("svg", "<svg><path d='M1 1h0x10'/></svg>",
                  "a:1: the path's data is wrong at character 7, 'x10'");
    check_refused("svg", "<svg><path d='M1 1hinf'/></svg>",
                  "a:1: the path's data is wrong at character 6, 'inf'");
    check_refused("svg", "<svg><path d='M1 1h1e308h1e308h1e308'/></svg>", "a:1: a path leaves all bounds");
    check_refused("svg", "<svg><polyline points='1 1 2'/></svg>", "a:1: the points have an x without a y");
    check_refused("svg", "<svg><polyline points='1 1 2 2 a'/></svg>",
                  "a:1: the points are wrong at character 9, 'a'");
    check_refused("svg", "<svg><line x2='b'/></svg>", "a:1: x2 of the line is no number");
    check_refused("svg", "<svg><g transform='mat(1 0 0 1 0 0)'/></svg>",
                  "a:1: the transform 'mat(1 0 0 1 0 0)' is not understood");
    check_refused("svg", "<svg><g transform='rotate(1'/></svg>",
                  "a:1: the transform 'rotate(1' is not understood");
}

static void test_svg_unread(void **state)
{
    (void)state;
    check_refused("svg", "<svg>\n<g>\n<text>a</text></g></svg>",
                  "a:3: a <text> is not read: make paths of it, or hide it");
    check_refused("svg", "<svg>\n<image/></svg>", "a:2: a <image> is not read: make paths of it, or hide it");
    check_refused("svg", "<svg>\n<use href='#b'/></svg>", "a:2: a <use> of '#b', which is not in this file");
    check_refused("svg", "<svg>\n<use href='b.svg#b'/></svg>",
                  "a:2: a <use> of 'b.svg#b', which is not in this file");
    check_refused("svg", "<svg>\n<g id='g'>\n<use href='#g'/></g></svg>",
                  "a:3: a <use> of itself, or 32 deep");
    check_refused("svg", "<svg><circle r='b'/></svg>", "a:1: r of the circle is no number");
    check_refused("svg", "<svg><circle r='2em'/></svg>",
                  "a:1: r of the circle is '2em': its unit is not read");
    check_refused("svg", "<svg>\n<style>g > .h{display:none}</style></svg>",
                  "a:2: the style's selector 'g > .h' is not read: only tags, .classes and #ids are");
    check_refused("svg", "<svg><style>@media print{.h{display:none}}</style></svg>",
                  "a:1: the style's rule '@media print' is not read: it moves or hides something");
    check_refused("svg", "<svg><g transform='scale(2)' style='transform-origin: 1px 1px'/></svg>",
                  "a:1: a transform-origin is not read");
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void test_files(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    static const char *const files[][2] = {
        {"strand.csv", "0.01, -0.01, 0\n0.02, -0.01, 0\n"},
        {"strand.OBJ", "v 0.01 -0.01 0\nv 0.02 -0.01 0\n"},
        {"strand.svg", "<svg width='1mm' viewBox='0 0 1 1'><path d='M10 10h10'/></svg>"}};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        PolylineFile file;
        Error err = {""};
        write_file(files[k][0], files[k][1]);
        if (!polyline_file_read(files[k][0], &file, &err)) fail_msg("%s", err.text);
        check_strand(&file, 0, 1e-3, 2, (const double[2][3]){{10, -10, 0}, {20, -10, 0}});
        polyline_file_clear(&file);
        remove(files[k][0]);
    }
    PolylineFile file;
    Error err;
    assert_false(polyline_file_read("strand.svg", &file, &err));
    assert_string_equal(err.text, "strand.svg: cannot be read: No such file or directory");
    check_refused("txt", "1 2 3", "a: a curve's points are read from .csv, .obj or .svg");
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_csv),        cmocka_unit_test(test_obj),
                                       cmocka_unit_test(test_svg_lines),  cmocka_unit_test(test_svg_curves),
                                       cmocka_unit_test(test_svg_places), cmocka_unit_test(test_svg_refused),
                                       cmocka_unit_test(test_svg_shapes), cmocka_unit_test(test_svg_clones),
                                       cmocka_unit_test(test_svg_styles), cmocka_unit_test(test_svg_unread),
                                       cmocka_unit_test(test_files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
