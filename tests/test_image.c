#include "base/memory.h"
#include "io/image.h"
#include "leaks.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

/* 3x1, grey, 16 bits: 0, 0x8080, 0xffff */
static const unsigned char png_grey16[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00, 0x01, 0x10, 0x00, 0x00, 0x00, 0x00, 0x6e,
    0x1b, 0x97, 0x2b, 0x00, 0x00, 0x00, 0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60,
    0x60, 0x68, 0x68, 0xf8, 0xff, 0x1f, 0x00, 0x06, 0x84, 0x02, 0xff, 0x46, 0x60, 0xde, 0xb6,
    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

/* 2x2, RGBA: red, green / black half transparent, blue fully transparent */
static const unsigned char png_rgba[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x06, 0x00, 0x00, 0x00, 0x72, 0xb6, 0x0d,
    0x24, 0x00, 0x00, 0x00, 0x13, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xcf, 0xc0, 0xf0,
    0x1f, 0x0c, 0x81, 0xa0, 0x01, 0xc4, 0x06, 0x00, 0x39, 0x5b, 0x05, 0x7c, 0xcd, 0xf4, 0x56, 0x3d,
    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

/* 2x1, palette: white, blue */
static const unsigned char png_palette[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x03, 0x00, 0x00, 0x00, 0xc3,
    0xfc, 0x8f, 0xb8, 0x00, 0x00, 0x00, 0x06, 0x50, 0x4c, 0x54, 0x45, 0x00, 0x00, 0xff, 0xff,
    0xff, 0xff, 0x7b, 0xdc, 0x99, 0x2c, 0x00, 0x00, 0x00, 0x0b, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9c, 0x63, 0x60, 0x64, 0x00, 0x00, 0x00, 0x05, 0x00, 0x02, 0xd1, 0x66, 0x33, 0x78, 0x00,
    0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

static void expect_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.17g is not %.17g", value, expected);
}

static void write_file(const char *path, const void *bytes, size_t length)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
}

static void expect_grey(const char *path, int width, int height, const double *grey)
{
    Image image;
    Error err = {""};
    if (!image_read(path, &image, &err)) fail_msg("%s", err.text);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    for (int i = 0; i < width * height; i++) expect_close(image.grey[i], grey[i], 1e-15);
    image_clear(&image);
}

static void pgm_kinds(void **state)
{
    (void)state;
    const char text[] = "P2 # made by hand\n3 2\n# levels\n10\n0 5 10\n1 2 3";
    write_file("image_text.pgm", text, sizeof text - 1);
    expect_grey("image_text.pgm", 3, 2, (const double[]){0, 0.5, 1, 0.1, 0.2, 0.3});
    write_file("image_bytes.pgm", "P5\n2 2\n255\n\x00\x33\xff\n", 15);
    expect_grey("image_bytes.pgm", 2, 2, (const double[]){0, 0.2, 1, 10 / 255.0});
    write_file("image_wide.pgm", "P5 2 1 65535\n\x01\x00\xff\xff", 17);
    expect_grey("image_wide.pgm", 2, 1, (const double[]){256 / 65535.0, 1});
    write_file("image_one.pgm", "P2 1 1 1 1", 10);
    expect_grey("image_one.pgm", 1, 1, (const double[]){1});
}

static void expect_rgb(const char *path, int width, int height, const double (*rgb)[3], double tolerance)
{
    Image planes[3];
    Error err = {""};
    if (!image_read_rgb(path, planes, &err)) fail_msg("%s", err.text);
    for (int c = 0; c < 3; c++) {
        assert_int_equal(planes[c].width, width);
        assert_int_equal(planes[c].height, height);
        for (int i = 0; i < width * height; i++) expect_close(planes[c].grey[i], rgb[i][c], tolerance);
        image_clear(&planes[c]);
    }
}

static void ppm_kinds(void **state)
{
    (void)state;
    const char text[] = "P3 2 1 4\n4 0 0  1 2 3";
    write_file("image_text.ppm", text, sizeof text - 1);
    expect_grey("image_text.ppm", 2, 1, (const double[]){0.2126, (0.2126 + 2 * 0.7152 + 3 * 0.0722) / 4});
    expect_rgb("image_text.ppm", 2, 1, (const double[][3]){{1, 0, 0}, {0.25, 0.5, 0.75}}, 1e-15);
    write_file("image_bytes.ppm", "P6 1 1 255\n\x00\x33\xff", 14);
    expect_rgb("image_bytes.ppm", 1, 1, (const double[][3]){{0, 0.2, 1}}, 1e-15);
    write_file("image_wide.ppm", "P6 1 1 65535\n\x01\x00\x00\x00\xff\xff", 19);
    expect_rgb("image_wide.ppm", 1, 1, (const double[][3]){{256 / 65535.0, 0, 1}}, 1e-15);
    write_file("image_grey.pgm", "P5 1 1 255\n\x33", 12);
    expect_rgb("image_grey.pgm", 1, 1, (const double[][3]){{0.2, 0.2, 0.2}}, 1e-15);
}

/* 16x8, black beside white; and red beside blue, which the tag turns to stand above it. */
static void jpeg_kinds(void **state)
{
    (void)state;
    Image image, rgb[3];
    Error err = {""};
    if (!image_read(SOURCE_DIR "/tests/images/grey.jpg", &image, &err)) fail_msg("%s", err.text);
    assert_int_equal(image.width, 16);
    assert_int_equal(image.height, 8);
    for (int i = 0; i < 128; i++) expect_close(image.grey[i], i % 16 >= 8, 0.01);
    image_clear(&image);
    if (!image_read_rgb(SOURCE_DIR "/tests/images/turned.jpg", rgb, &err)) fail_msg("%s", err.text);
    assert_int_equal(rgb[0].width, 8);
    assert_int_equal(rgb[0].height, 16);
    for (int i = 0; i < 128; i++) {
        expect_close(rgb[0].grey[i], i < 64, 0.01);
        expect_close(rgb[1].grey[i], 0, 0.01);
        expect_close(rgb[2].grey[i], i >= 64, 0.01);
    }
    for (int c = 0; c < 3; c++) image_clear(&rgb[c]);
}

static void png_kinds(void **state)
{
    (void)state;
    write_file("image_grey16.png", png_grey16, sizeof png_grey16);
    expect_grey("image_grey16.png", 3, 1, (const double[]){0, 128 / 255.0, 1});
    write_file("image_rgba.png", png_rgba, sizeof png_rgba);
    expect_rgb("image_rgba.png", 2, 2,
               (const double[][3]){{1, 0, 0}, {0, 1, 0}, {127 / 255.0, 127 / 255.0, 127 / 255.0}, {1, 1, 1}},
               1e-15);
    expect_grey("image_rgba.png", 2, 2, (const double[]){0.2126, 0.7152, 127 / 255.0, 1});
    write_file("image_palette.png", png_palette, sizeof png_palette);
    expect_grey("image_palette.png", 2, 1, (const double[]){1, 0.0722});
}

static void expect_refused(const char *path, const char *sentence)
{
    Image image;
    Error err = {""};
    assert_false(image_read(path, &image, &err));
    assert_string_equal(err.text, sentence);
    assert_null(image.grey);
    assert_int_equal(image.width, 0);
}

static void pgm_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence;
    } bad[] = {
        {"P5", "bad.pgm:1: the file ends where the width should be"},
        {"P5\nwide 2 255 ", "bad.pgm:2: the width must be a whole number from 1 to 400000000"},
        {"P5\n0 2 255 ", "bad.pgm:2: the width must be a whole number from 1 to 400000000"},
        {"P5\n2 -2 255 ", "bad.pgm:2: the height must be a whole number from 1 to 400000000"},
        {"P5 99999999999999999999 1 255 ", "bad.pgm:1: the width must be a whole number from 1 to 400000000"},
        {"P5 20001 20000 255 ",
         "bad.pgm: an image of 20001 x 20000 pixels; at most 400 million are read: make it smaller"},
        {"P5 10000 10000 255 abc", "bad.pgm: the file ends before the last of 10000 x 10000 pixels"},
        {"P5 2 2 255 abc", "bad.pgm: the file ends before the last of 2 x 2 pixels"},
        {"P5 2 1 65535 abc", "bad.pgm: the file ends before the last of 2 x 1 pixels"},
        {"P5 1 1 65536 a", "bad.pgm:1: the greatest level must be a whole number from 1 to 65535"},
        {"P5 1 1 0 a", "bad.pgm:1: the greatest level must be a whole number from 1 to 65535"},
        {"P5 2 1 96 aa", "bad.pgm: level 97 of pixel 0 exceeds the file's maximum 96"},
        {"P2 2 1 255\n1\n256", "bad.pgm:3: the level must be a whole number from 0 to 255"},
        {"P2 2 1 255\n1 x", "bad.pgm:2: the level must be a whole number from 0 to 255"},
        {"P2 2 1 255\n123 \n", "bad.pgm:3: the file ends where the level should be"},
        {"P2 2 1 255\n1", "bad.pgm: the file ends before the last of 2 x 1 pixels"},
        {"P6 1 1 255 ab", "bad.pgm: the file ends before the last of 1 x 1 pixels"},
        {"P3 1 1 9 1 2 10", "bad.pgm:1: the level must be a whole number from 0 to 9"},
        {"P4 1 1 a", "bad.pgm: not a PNG, JPEG, PGM or PPM image; convert it to PNG"},
        {"P", "bad.pgm: not a PNG, JPEG, PGM or PPM image; convert it to PNG"},
        {"", "bad.pgm: the file is empty"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        write_file("bad.pgm", bad[i].text, strlen(bad[i].text));
        expect_refused("bad.pgm", bad[i].sentence);
    }
    remove("bad.pgm");
    expect_refused("bad.pgm", "bad.pgm: cannot be read: No such file or directory");
    expect_refused("/", "/: cannot be read: Is a directory");
}

static void jpeg_refused(void **state)
{
    (void)state;
    expect_refused(SOURCE_DIR "/tests/images/cmyk.jpg",
                   SOURCE_DIR "/tests/images/cmyk.jpg: a JPEG of 4 colours; save it as RGB or grey");
    FILE *file = fopen(SOURCE_DIR "/tests/images/turned.jpg", "rb");
    assert_non_null(file);
    unsigned char bytes[1024];
    size_t length = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    for (size_t cut = 3; cut < length - 2; cut++) {
        Image image;
        Error err = {""};
        assert_false(image_parse("cut.jpg", bytes, cut, &image, &err));
        assert_non_null(strstr(err.text, "cut.jpg: the JPEG data are broken: "));
        assert_null(image.grey);
    }
    unsigned char *size = memmem(bytes, length, "\xff\xc2\x00\x11\x08", 5);
    assert_non_null(size);
    memcpy(size + 5, "\xff\xdc\xff\xdc", 4);
    write_file("bad.jpg", bytes, length);
    expect_refused(
        "bad.jpg",
        "bad.jpg: an image of 65500 x 65500 pixels; at most 400 million are read: make it smaller");
    memcpy(size + 5, "\x10\x00\x10\x00", 4);
    write_file("bad.jpg", bytes, length);
    expect_refused("bad.jpg", "bad.jpg: the file ends before the last of 4096 x 4096 pixels");
}

static void png_refused(void **state)
{
    (void)state;
    unsigned char bytes[sizeof png_rgba];
    memcpy(bytes, png_rgba, sizeof bytes);
    write_file("bad.png", bytes, 20);
    expect_refused("bad.png", "bad.png: not a PNG file");
    Image image;
    Error err = {""};
    for (size_t length = 24; length < sizeof bytes - 12; length++) { /* without any of the last chunk */
        write_file("bad.png", bytes, length);
        assert_false(image_read("bad.png", &image, &err));
        assert_non_null(strstr(err.text, "bad.png: the PNG data are broken"));
    }
    bytes[45] ^= 1; /* the check sum sees it */
    write_file("bad.png", bytes, sizeof bytes);
    assert_false(image_read("bad.png", &image, &err));
    assert_non_null(strstr(err.text, "bad.png: the PNG data are broken"));

    memcpy(bytes + 16, "\0\0\x4e\x21\0\0\x4e\x20", 8);
    write_file("bad.png", bytes, sizeof bytes);
    expect_refused(
        "bad.png",
        "bad.png: an image of 20001 x 20000 pixels; at most 400 million are read: make it smaller");
    memcpy(bytes + 16, "\0\0\x4e\x20\0\0\x4e\x20", 8);
    write_file("bad.png", bytes, sizeof bytes);
    expect_refused("bad.png", "bad.png: the file ends before the last of 20000 x 20000 pixels");
    memcpy(bytes + 16, "\0\0\x7d\x01\0\0\0\1", 8);
    write_file("bad.png", bytes, sizeof bytes);
    expect_refused("bad.png", "bad.png: an image of 32001 x 1 pixels; at most 32000 a side are read");
    memcpy(bytes + 16, "\0\0\0\0\0\0\0\1", 8);
    write_file("bad.png", bytes, sizeof bytes);
    expect_refused("bad.png", "bad.png: the image has no pixels");
}

static size_t load(const char *path, unsigned char *bytes, size_t room)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t length = fread(bytes, 1, room, file);
    fclose(file);
    return length;
}

/* The pixels of these bytes are those of the whole. */
static void expect_same(const unsigned char *bytes, size_t length, const Image *whole)
{
    Image image;
    Error err = {""};
    if (!image_parse("cut", bytes, length, &image, &err)) fail_msg("%zu bytes: %s", length, err.text);
    assert_int_equal(image.width, whole->width);
    assert_int_equal(image.height, whole->height);
    assert_memory_equal(image.grey, whole->grey,
                        (size_t)image.width * (size_t)image.height * sizeof *image.grey);
    image_clear(&image);
}

/* What comes after the last pixel may be missing, or be anything: end markers of JPEG (one of a single scan,
 * one of several), IEND of PNG, whatever follows. */
static void without_ends(void **state)
{
    (void)state;
    static const char *const paths[] = {SOURCE_DIR "/tests/images/grey.jpg",
                                        SOURCE_DIR "/tests/images/turned.jpg", "image_rgba.png"};
    static const size_t ends[] = {2, 2, 12};
    write_file("image_rgba.png", png_rgba, sizeof png_rgba);
    for (int k = 0; k < 3; k++) {
        unsigned char bytes[2048];
        Image whole;
        Error err = {""};
        size_t length = load(paths[k], bytes, sizeof bytes - 64);
        if (!image_parse(paths[k], bytes, length, &whole, &err)) fail_msg("%s", err.text);
        for (size_t cut = 1; cut <= ends[k]; cut++) expect_same(bytes, length - cut, &whole);
        memset(bytes + length, 'x', 64);
        expect_same(bytes, length + 64, &whole);
        assert_false(image_parse("cut", bytes, length - ends[k] - 1, &(Image){0}, &err));
        image_clear(&whole);
    }
    write_file("image_rest.pgm", "P5 2 1 255\n\0\xff and more", 22);
    expect_grey("image_rest.pgm", 2, 1, (const double[]){0, 1});
    write_file("image_rest.pgm", "P2 2 1 255\n0 255", 16);
    expect_grey("image_rest.pgm", 2, 1, (const double[]){0, 1});
}

/* The cyclic redundancy check of PNG, bit by bit. */
static unsigned crc_of(const unsigned char *bytes, size_t length)
{
    unsigned crc = ~0u;
    for (size_t i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

/* png_rgba with a chunk eXIf of one tag after its header; returns its length. */
static size_t add_orientation(unsigned char *bytes, int tag)
{
    unsigned char chunk[38] = {0, 0, 0, 26, 'e', 'X',  'I', 'f', 'M', 'M', 0, 42, 0, 0,
                               0, 8, 0, 1,  1,   0x12, 0,   3,   0,   0,   0, 1,  0, (unsigned char)tag};
    unsigned crc = crc_of(chunk + 4, 30);
    for (int k = 0; k < 4; k++) chunk[34 + k] = (unsigned char)(crc >> (24 - 8 * k));
    memcpy(bytes, png_rgba, 33);
    memcpy(bytes + 33, chunk, 38);
    memcpy(bytes + 71, png_rgba + 33, sizeof png_rgba - 33);
    return sizeof png_rgba + 38;
}

/* Red and green above grey and white, turned by each tag [Exif 2.3: where row 0 and column 0 are]. */
static void png_orientation(void **state)
{
    (void)state;
    static const int pixel[9][4] = {{0},          {0, 1, 2, 3}, {1, 0, 3, 2}, {3, 2, 1, 0}, {2, 3, 0, 1},
                                    {0, 2, 1, 3}, {2, 0, 3, 1}, {3, 1, 2, 0}, {1, 3, 0, 2}};
    static const double grey[4] = {0.2126, 0.7152, 127 / 255.0, 1};
    for (int tag = 1; tag <= 8; tag++) {
        unsigned char bytes[sizeof png_rgba + 38];
        Image image;
        Error err = {""};
        if (!image_parse("turned.png", bytes, add_orientation(bytes, tag), &image, &err))
            fail_msg("%s", err.text);
        for (int k = 0; k < 4; k++) expect_close(image.grey[k], grey[pixel[tag][k]], 1e-15);
        image_clear(&image);
    }
}

/* 7 x 5 pixels of which 3 x 2 are useful: boxes of 2 or 3 a side, each its mean. */
static void boxes(void **state)
{
    (void)state;
    char text[256] = "P2 7 5 34";
    static const int left[] = {0, 2, 4, 7}, top[] = {0, 2, 5};
    Image image, rgb[3];
    Error err = {""};
    for (int i = 0; i < 35; i++) sprintf(text + strlen(text), " %d", i);
    write_file("image_boxes.pgm", text, strlen(text));
    if (!image_read_useful("image_boxes.pgm", (const double[]){3, 2.5}, &image, rgb, &err))
        fail_msg("%s", err.text);
    assert_true(image.width == 3 && image.height == 2);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++) {
            double sum = 0, count = 0;
            for (int y = top[i]; y < top[i + 1]; y++)
                for (int x = left[j]; x < left[j + 1]; x++) sum += 7 * y + x, count++;
            expect_close(image.grey[3 * i + j], sum / count / 34, 1e-15);
            expect_close(rgb[2].grey[3 * i + j], sum / count / 34, 1e-15);
        }
    image_clear(&image);
    for (int c = 0; c < 3; c++) image_clear(&rgb[c]);

    /* what is useful is counted upright: 16 x 8 pixels that stand */
    const char *turned = SOURCE_DIR "/tests/images/turned.jpg";
    assert_true(image_read_useful(turned, (const double[]){8, 8}, &image, NULL, &err));
    assert_true(image.width == 8 && image.height == 16);
    image_clear(&image);
    assert_true(image_read_useful(turned, (const double[]){2, 4}, &image, NULL, &err));
    assert_true(image.width == 2 && image.height == 4);
    image_clear(&image);
}

/* Pixel centres give the pixels, the middle between two their mean; beyond the edges nothing changes any
 * more. */
static void samples(void **state)
{
    (void)state;
    double grey[] = {0, 1, 0.5, 0.25, 0.75, 1};
    Image image = {3, 2, grey};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++)
            expect_close(image_sample(&image, (j + 0.5) / 3, (i + 0.5) / 2), grey[3 * i + j], 1e-15);
    expect_close(image_sample(&image, 1.0 / 3, 0.25), 0.5, 1e-15);
    expect_close(image_sample(&image, 1.0 / 3, 0.5), 0.5, 1e-15);
    expect_close(image_sample(&image, 0.5, 0.5), 0.875, 1e-15);
    expect_close(image_sample(&image, 0.5 / 3 + 0.1 / 3, 0.25), 0.1, 1e-15);
    expect_close(image_sample(&image, -7, -7), 0, 0);
    expect_close(image_sample(&image, 9, 9), 1, 0);
    expect_close(image_sample(&image, 0, 1), 0.25, 0);
    double one = 0.3;
    Image pixel = {1, 1, &one};
    expect_close(image_sample(&pixel, 0.9, 0.1), 0.3, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(pgm_kinds, nothing_leaks),
        cmocka_unit_test_teardown(ppm_kinds, nothing_leaks),
        cmocka_unit_test_teardown(jpeg_kinds, nothing_leaks),
        cmocka_unit_test_teardown(jpeg_refused, nothing_leaks),
        cmocka_unit_test_teardown(png_kinds, nothing_leaks),
        cmocka_unit_test_teardown(pgm_refused, nothing_leaks),
        cmocka_unit_test_teardown(png_refused, nothing_leaks),
        cmocka_unit_test_teardown(without_ends, nothing_leaks),
        cmocka_unit_test_teardown(png_orientation, nothing_leaks),
        cmocka_unit_test_teardown(boxes, nothing_leaks),
        cmocka_unit_test_teardown(samples, nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
