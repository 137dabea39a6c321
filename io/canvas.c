#include "io/canvas.h"
#include "base/memory.h"
#include "base/plain.h"
#include "io/mark.h"
#include "io/safe_file.h"
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MAX_POINTS = 10000, PNG_BAND = 64 };

/* Alike on all machines, with all the signs of ticks.c; where it is not there, Cairo takes the machine's own. */
static const char FONT[] = "DejaVu Sans";

typedef enum Format { FORMAT_PNG, FORMAT_SVG, FORMAT_PDF, FORMAT_COUNT } Format;

static const char *const endings[FORMAT_COUNT] = {".png", ".svg", ".pdf"};

/* The file's bytes until they are saved. */
typedef struct Bytes {
    unsigned char *data;
    size_t length, capacity;
} Bytes;

struct Canvas {
    cairo_t *cairo;
    cairo_surface_t *surface;
    Format format;
    double resolution;
    char *path;
    Bytes file;
};

/* Read by the leak checker of sanitized builds: Cairo and fontconfig keep a few fonts for good, behind
 * offsets that the checker cannot follow. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libfontconfig";
}

/* Nor does that checker count, on standard error, what it was told to ignore. */
const char *__lsan_default_options(void);
const char *__lsan_default_options(void)
{
    return "print_suppressions=0";
}

static cairo_status_t bytes_append(void *self, const unsigned char *data, unsigned length)
{
    Bytes *bytes = self;
    if (bytes->length + length > bytes->capacity) {
        size_t capacity = 2 * (bytes->length + length);
        bytes->data = mem_resize(bytes->data, bytes->capacity, capacity, 1);
        bytes->capacity = capacity;
    }
    memcpy(bytes->data + bytes->length, data, length);
    bytes->length += length;
    return CAIRO_STATUS_SUCCESS;
}

/* FORMAT_COUNT for an unknown ending. */
static Format format_from_path(const char *path)
{
    const char *ending = strrchr(path, '.');
    int format = 0;
    while (format < FORMAT_COUNT && (!ending || strcasecmp(ending, endings[format]) != 0)) format++;
    return (Format)format;
}

static void check_memory(cairo_status_t status)
{
    if (status == CAIRO_STATUS_NO_MEMORY) mem_exhausted("Cairo");
}

static cairo_surface_t *image_create(cairo_format_t format, int width, int height)
{
    cairo_surface_t *image = cairo_image_surface_create(format, width, height);
    check_memory(cairo_surface_status(image));
    return image;
}

static cairo_surface_t *surface_create(Canvas *canvas, double width, double height)
{
    if (canvas->format == FORMAT_SVG)
        return cairo_svg_surface_create_for_stream(bytes_append, &canvas->file, width, height);
    if (canvas->format == FORMAT_PDF)
        return cairo_pdf_surface_create_for_stream(bytes_append, &canvas->file, width, height);
    return image_create(CAIRO_FORMAT_RGB24, (int)lround(width * canvas->resolution),
                        (int)lround(height * canvas->resolution));
}

/* Glyphs are placed the same at every resolution and in every format. */
static void disable_hinting(cairo_t *cairo)
{
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(cairo, options);
    cairo_font_options_destroy(options);
}

bool canvas_check_path(const char *path, Error *err)
{
    return format_from_path(path) != FORMAT_COUNT ||
           error_set(err,
                     "%s: pictures are written as .png, .svg or .pdf; give the file one of these endings",
                     path);
}

Canvas *canvas_create(const char *path, double width, double height, double resolution, Error *err)
{
    Format format = format_from_path(path);
    if (!canvas_check_path(path, err)) return NULL;
    double pixels = format == FORMAT_PNG ? resolution : 1;
    bool fits = width >= 1 && height >= 1 && width <= MAX_POINTS && height <= MAX_POINTS &&
                width * pixels <= CANVAS_MAX_SIDE && height * pixels <= CANVAS_MAX_SIDE;
    if (!fits || !(resolution > 0)) {
        error_set(err, "%s: a page of %g x %g points; 1 to %d points are allowed, and %d pixels in a PNG",
                  path, width, height, MAX_POINTS, CANVAS_MAX_SIDE);
        return NULL;
    }
    Canvas *canvas = mem_alloc(1, sizeof *canvas);
    canvas->format = format;
    canvas->resolution = resolution;
    canvas->path = mem_text(path);
    canvas->surface = surface_create(canvas, width, height);
    canvas->cairo = cairo_create(canvas->surface);
    if (format == FORMAT_PNG) cairo_scale(canvas->cairo, resolution, resolution);
    disable_hinting(canvas->cairo);
    cairo_set_line_cap(canvas->cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(canvas->cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_source_rgb(canvas->cairo, 1, 1, 1);
    cairo_paint(canvas->cairo);
    return canvas;
}

void canvas_destroy(Canvas *canvas)
{
    if (!canvas) return;
    cairo_destroy(canvas->cairo);
    cairo_surface_destroy(canvas->surface);
    mem_free(canvas->file.data);
    mem_free(canvas->path);
    mem_free(canvas);
}

double canvas_resolution(const Canvas *canvas)
{
    return canvas->resolution;
}

/* The whole file says who has made it, before its end, which has so many bytes. */
static void add_mark(Bytes *file, Format format)
{
    static const size_t ends[FORMAT_COUNT] = {MARK_PNG_END, sizeof "</svg>\n" - 1, sizeof "%%EOF\n" - 1};
    static const char *const comments[FORMAT_COUNT] = {
        [FORMAT_SVG] = MARK_SVG(SLENDER_VERSION), [FORMAT_PDF] = MARK_PDF(SLENDER_VERSION)};
    unsigned char end[MARK_PNG_END], *chunk = NULL;
    size_t size = 0;
    if (format == FORMAT_PNG) chunk = mark_png_chunk(&size);
    file->length -= ends[format];
    memcpy(end, file->data + file->length, ends[format]);
    if (chunk)
        bytes_append(file, chunk, (unsigned)size);
    else
        bytes_append(file, (const unsigned char *)comments[format], (unsigned)strlen(comments[format]));
    bytes_append(file, end, (unsigned)ends[format]);
    mem_free(chunk);
}

bool canvas_save(Canvas *canvas, Error *err)
{
    cairo_status_t status = cairo_status(canvas->cairo);
    if (status == CAIRO_STATUS_SUCCESS && canvas->format == FORMAT_PNG)
        status = cairo_surface_write_to_png_stream(canvas->surface, bytes_append, &canvas->file);
    cairo_surface_finish(canvas->surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(canvas->surface);
    check_memory(status);
    if (status != CAIRO_STATUS_SUCCESS)
        return error_set(err, "%s: cannot be drawn: %s", canvas->path, cairo_status_to_string(status));
    add_mark(&canvas->file, canvas->format);
    return safe_file_write(canvas->path, canvas->file.data, canvas->file.length, false, err);
}

const unsigned char *canvas_pixels(Canvas *canvas, int *width, int *height, int *stride)
{
    cairo_surface_flush(canvas->surface);
    *width = cairo_image_surface_get_width(canvas->surface);
    *height = cairo_image_surface_get_height(canvas->surface);
    *stride = cairo_image_surface_get_stride(canvas->surface);
    return cairo_image_surface_get_data(
        canvas->surface); /* native words ARGB, on little-endian machines B, G, R, A */
}

static void set_color(Canvas *canvas, Color color)
{
    cairo_set_source_rgba(canvas->cairo, color.r, color.g, color.b, color.a);
}

static void trace(Canvas *canvas, const Vec2 *points, int count)
{
    for (int i = 0; i < count; i++) cairo_line_to(canvas->cairo, points[i].x, points[i].y);
}

static void stroke(Canvas *canvas, Pen pen)
{
    set_color(canvas, pen.color);
    cairo_set_line_width(canvas->cairo, pen.width);
    cairo_set_dash(canvas->cairo, &pen.dash, pen.dash > 0, 0);
    cairo_stroke(canvas->cairo);
}

void canvas_line(Canvas *canvas, Vec2 from, Vec2 to, Pen pen)
{
    canvas_polyline(canvas, (const Vec2[]){from, to}, 2, pen);
}

void canvas_polyline(Canvas *canvas, const Vec2 *points, int count, Pen pen)
{
    trace(canvas, points, count);
    stroke(canvas, pen);
}

void canvas_polygon(Canvas *canvas, const Vec2 *points, int count, Color fill)
{
    trace(canvas, points, count);
    cairo_close_path(canvas->cairo);
    set_color(canvas, fill);
    cairo_fill(canvas->cairo);
}

void canvas_rings(Canvas *canvas, const Vec2 *points, const int *first, int count, Color fill)
{
    for (int k = 0; k < count; k++) {
        cairo_new_sub_path(canvas->cairo);
        trace(canvas, points + first[k], first[k + 1] - first[k]);
        cairo_close_path(canvas->cairo);
    }
    set_color(canvas, fill);
    cairo_set_fill_rule(canvas->cairo, CAIRO_FILL_RULE_EVEN_ODD);
    cairo_fill(canvas->cairo);
    cairo_set_fill_rule(canvas->cairo, CAIRO_FILL_RULE_WINDING);
}

void canvas_circle(Canvas *canvas, Vec2 center, double radius, Color fill)
{
    cairo_arc(canvas->cairo, center.x, center.y, radius, 0, 2 * acos(-1));
    set_color(canvas, fill);
    cairo_fill(canvas->cairo);
}

void canvas_fill(Canvas *canvas, Box box, Color fill)
{
    cairo_rectangle(canvas->cairo, box.x, box.y, box.width, box.height);
    set_color(canvas, fill);
    cairo_fill(canvas->cairo);
}

void canvas_frame(Canvas *canvas, Box box, Pen pen)
{
    cairo_rectangle(canvas->cairo, box.x, box.y, box.width, box.height);
    stroke(canvas, pen);
}

void canvas_arrow(Canvas *canvas, Vec2 tail, Vec2 tip, Pen pen)
{
    double dx = tip.x - tail.x, dy = tip.y - tail.y, length = hypot(dx, dy);
    if (!(length > 0)) return;
    double head = 5 * pen.width, shrink = fmin(1, length / head);
    head *= shrink;
    pen.width *= shrink;
    dx *= head / length;
    dy *= head / length;
    Vec2 neck = {tip.x - 0.9 * dx, tip.y - 0.9 * dy};
    canvas_line(canvas, tail, neck, pen);
    canvas_polygon(canvas,
                   (const Vec2[]){tip,
                                  {tip.x - dx - 0.35 * dy, tip.y - dy + 0.35 * dx},
                                  neck,
                                  {tip.x - dx + 0.35 * dy, tip.y - dy - 0.35 * dx}},
                   4, pen.color);
}

static void select_font(Canvas *canvas, TextStyle style)
{
    cairo_select_font_face(canvas->cairo, FONT, CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(canvas->cairo, style.size);
}

/* Cairo draws nothing more after a text that is no UTF-8. */
static double text_width(Canvas *canvas, const char *plain, TextStyle style)
{
    cairo_text_extents_t extents;
    select_font(canvas, style);
    cairo_text_extents(canvas->cairo, plain, &extents);
    return extents.x_advance;
}

double canvas_text_width(Canvas *canvas, const char *text, TextStyle style)
{
    char *plain = plain_text(text, "");
    double width = text_width(canvas, plain, style);
    mem_free(plain);
    return width;
}

void canvas_text(Canvas *canvas, Vec2 at, const char *text, TextStyle style)
{
    char *plain = plain_text(text, "");
    double width = text_width(canvas, plain, style);
    cairo_save(canvas->cairo);
    cairo_translate(canvas->cairo, at.x, at.y);
    if (style.upwards) cairo_rotate(canvas->cairo, -acos(-1) / 2);
    cairo_move_to(canvas->cairo, -0.5 * style.align * width, 0);
    set_color(canvas, style.color);
    cairo_show_text(canvas->cairo, plain);
    cairo_restore(canvas->cairo);
    cairo_new_path(canvas->cairo);
    mem_free(plain);
}

void canvas_begin_ink(Canvas *canvas)
{
    cairo_push_group(canvas->cairo);
}

void canvas_end_ink(Canvas *canvas)
{
    cairo_pop_group_to_source(canvas->cairo);
    cairo_set_operator(canvas->cairo, CAIRO_OPERATOR_MULTIPLY);
    cairo_paint(canvas->cairo);
    cairo_set_operator(canvas->cairo, CAIRO_OPERATOR_OVER);
}

void canvas_clip(Canvas *canvas, Box box)
{
    cairo_save(canvas->cairo);
    cairo_rectangle(canvas->cairo, box.x, box.y, box.width, box.height);
    cairo_clip(canvas->cairo);
}

void canvas_unclip(Canvas *canvas)
{
    cairo_restore(canvas->cairo);
}

/* Cairo's pixels are native 32-bit words, alpha first, with the colours already multiplied by alpha. */
static uint32_t pixel_premultiplied(const unsigned char rgba[4])
{
    uint32_t a = rgba[3], word = a << 24;
    for (int c = 0; c < 3; c++) word |= ((rgba[c] * a + 127) / 255) << (16 - 8 * c);
    return word;
}

void canvas_image(Canvas *canvas, const unsigned char *rgba, int width, int height, Box box)
{
    cairo_surface_t *image = image_create(CAIRO_FORMAT_ARGB32, width, height);
    unsigned char *data = cairo_image_surface_get_data(image);
    int stride = cairo_image_surface_get_stride(image);
    for (int i = 0; data && i < height; i++)
        for (int j = 0; j < width; j++) {
            uint32_t word = pixel_premultiplied(rgba + 4 * ((size_t)i * (size_t)width + (size_t)j));
            memcpy(data + (size_t)i * (size_t)stride + 4 * (size_t)j, &word, sizeof word);
        }
    cairo_surface_mark_dirty(image);
    cairo_save(canvas->cairo);
    cairo_translate(canvas->cairo, box.x, box.y);
    cairo_scale(canvas->cairo, box.width / width, box.height / height);
    cairo_set_source_surface(canvas->cairo, image, 0, 0);
    cairo_paint(canvas->cairo);
    cairo_restore(canvas->cairo);
    cairo_surface_destroy(image);
}

/* A PNG's bytes, and those of an IEND after them. */
typedef struct PngBytes {
    const unsigned char *at;
    size_t left;
    bool ending;
} PngBytes;

static cairo_status_t png_bytes_read(void *self, unsigned char *data, unsigned length)
{
    static const unsigned char ending[] = "\0\0\0\0IEND\xae\x42\x60\x82";
    PngBytes *bytes = self;
    while (length > 0) {
        if (bytes->left == 0 && bytes->ending) return CAIRO_STATUS_READ_ERROR;
        if (bytes->left == 0) *bytes = (PngBytes){ending, 12, true};
        size_t part = bytes->left < length ? bytes->left : length;
        memcpy(data, bytes->at, part);
        bytes->at += part, bytes->left -= part;
        data += part, length -= (unsigned)part;
    }
    return CAIRO_STATUS_SUCCESS;
}

/* Paints rows of the image from `first` on over white, so that Cairo turns any kind of PNG into the same
 * pixels. */
static cairo_status_t flatten(cairo_surface_t *png, int first, cairo_surface_t *band)
{
    cairo_t *cairo = cairo_create(band);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_set_source_surface(cairo, png, 0, -first);
    cairo_paint(cairo);
    cairo_status_t status = cairo_status(cairo);
    cairo_destroy(cairo);
    cairo_surface_flush(band);
    return status;
}

static void pixels_rgb(const unsigned char *pixels, int width, unsigned char *rgb)
{
    for (int j = 0; j < width; j++) {
        uint32_t word;
        memcpy(&word, pixels + 4 * (size_t)j, sizeof word);
        for (int c = 0; c < 3; c++) *rgb++ = (unsigned char)(word >> (16 - 8 * c));
    }
}

static cairo_status_t take_rows(cairo_surface_t *png, CanvasRow *row, void *self)
{
    int width = cairo_image_surface_get_width(png), height = cairo_image_surface_get_height(png);
    cairo_surface_t *band = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, PNG_BAND);
    cairo_status_t status = cairo_surface_status(band);
    unsigned char *rgb = mem_alloc(3 * (size_t)width, 1);
    for (int i = 0; status == CAIRO_STATUS_SUCCESS && i < height; i++) {
        if (i % PNG_BAND == 0) status = flatten(png, i, band);
        size_t stride = (size_t)cairo_image_surface_get_stride(band);
        pixels_rgb(cairo_image_surface_get_data(band) + (size_t)(i % PNG_BAND) * stride, width, rgb);
        row(self, i, rgb);
    }
    mem_free(rgb);
    cairo_surface_destroy(band);
    return status;
}

bool canvas_read_png(const char *path, const unsigned char *png, size_t length, CanvasRow *row, void *self,
                     Error *err)
{
    PngBytes bytes = {png, length, false};
    cairo_surface_t *surface = cairo_image_surface_create_from_png_stream(png_bytes_read, &bytes);
    cairo_status_t status = cairo_surface_status(surface);
    if (status != CAIRO_STATUS_SUCCESS) /* Cairo's reason may be anything, even a lack of memory */
        error_set(err, "%s: the PNG data are broken", path);
    else if ((status = take_rows(surface, row, self)) != CAIRO_STATUS_SUCCESS)
        error_set(err, "%s: %s", path, cairo_status_to_string(status));
    cairo_surface_destroy(surface);
    return status == CAIRO_STATUS_SUCCESS;
}
