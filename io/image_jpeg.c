/* JPEG through libjpeg: baseline and progressive, grey and colour, upright as the camera's orientation tag
 * says [Exif 2.3]. */
#include "base/memory.h"
#include "io/image.h"
#include "io/image_reader.h"
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <jerror.h>
#include <jpeglib.h>

enum { SCANS_MAX = 200 }; /* more of them are an attack, not a picture */

/* What libjpeg's callbacks need; libjpeg itself knows the first members. */
typedef struct Decoder {
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    struct jpeg_decompress_struct jpeg;
    const ImageBytes *file;
    Error *err;
    unsigned char *row;
    jmp_buf failed;
} Decoder;

static _Noreturn void stop(j_common_ptr jpeg)
{
    Decoder *decoder = (Decoder *)jpeg->err;
    char reason[JMSG_LENGTH_MAX];
    if (jpeg->err->msg_code == JERR_OUT_OF_MEMORY) mem_exhausted("libjpeg");
    jpeg->err->format_message(jpeg, reason);
    error_set(decoder->err, "%s: the JPEG data are broken: %s", decoder->file->path, reason);
    longjmp(decoder->failed, 1);
}

/* libjpeg goes on with grey where data are missing; oddities that lose nothing pass. */
static void hear_warning(j_common_ptr jpeg, int level)
{
    int code = jpeg->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE))
        stop(jpeg);
}

static void check_scans(j_common_ptr jpeg)
{
    Decoder *decoder = (Decoder *)jpeg->err;
    if (decoder->jpeg.input_scan_number <= SCANS_MAX) return;
    error_set(decoder->err, "%s: the JPEG data are broken: more than %d scans", decoder->file->path,
              SCANS_MAX);
    longjmp(decoder->failed, 1);
}

static unsigned read_word(const unsigned char *bytes, bool little, int size)
{
    unsigned word = 0;
    for (int k = 0; k < size; k++) word = word << 8 | bytes[little ? size - 1 - k : k];
    return word;
}

/* The tag 0x0112 of the first directory: 1 upright .. 8, as the Exif standard counts them. */
static int exif_orientation(const struct jpeg_decompress_struct *jpeg)
{
    for (jpeg_saved_marker_ptr marker = jpeg->marker_list; marker; marker = marker->next) {
        const unsigned char *tiff = marker->data + 6;
        if (marker->data_length < 14 || memcmp(marker->data, "Exif\0", 6) != 0) continue;
        size_t length = marker->data_length - 6;
        bool little = tiff[0] == 'I';
        size_t at = read_word(tiff + 4, little, 4);
        if (at + 2 > length) continue;
        unsigned entries = read_word(tiff + at, little, 2);
        for (at += 2; entries > 0 && at + 12 <= length; entries--, at += 12)
            if (read_word(tiff + at, little, 2) == 0x0112) {
                unsigned value = read_word(tiff + at + 8, little, 2);
                return value >= 1 && value <= 8 ? (int)value : 1;
            }
    }
    return 1;
}

/* Reads row by row, each pixel to its place in the upright picture: tags 5 to 8 exchange rows and columns,
 * then 2, 3, 6, 7 turn left and right around and 3, 4, 7, 8 top and bottom. */
static void read_rows(Decoder *decoder, Levels *levels, int orientation)
{
    struct jpeg_decompress_struct *jpeg = &decoder->jpeg;
    bool swap = orientation >= 5,
         mirror = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    bool flip = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    int width = (int)jpeg->output_width, channels = levels->channels;
    while (jpeg->output_scanline < jpeg->output_height) {
        int i = (int)jpeg->output_scanline;
        jpeg_read_scanlines(jpeg, &decoder->row, 1);
        for (int j = 0; j < width; j++) {
            int x = swap ? i : j, y = swap ? j : i;
            if (mirror) x = levels->width - 1 - x;
            if (flip) y = levels->height - 1 - y;
            uint16_t *level =
                levels->level + ((size_t)y * (size_t)levels->width + (size_t)x) * (size_t)channels;
            for (int c = 0; c < channels; c++) level[c] = decoder->row[j * channels + c];
        }
    }
}

static bool decode(Decoder *decoder, Levels *levels)
{
    struct jpeg_decompress_struct *jpeg = &decoder->jpeg;
    jpeg_mem_src(jpeg, decoder->file->bytes, decoder->file->length);
    jpeg_save_markers(jpeg, JPEG_APP0 + 1, 0xffff);
    jpeg_read_header(jpeg, TRUE);
    if (jpeg->num_components != 1 && jpeg->num_components != 3)
        return error_set(decoder->err, "%s: a JPEG of %d colours; save it as RGB or grey",
                         decoder->file->path, jpeg->num_components);
    jpeg->out_color_space = jpeg->num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    int orientation = exif_orientation(jpeg), width = (int)jpeg->image_width,
        height = (int)jpeg->image_height;
    bool swap = orientation >= 5;
    *levels = (Levels){.width = swap ? height : width,
                       .height = swap ? width : height,
                       .channels = jpeg->num_components,
                       .maximum = 255};
    size_t blocks = (size_t)width * (size_t)height / 64; /* each takes at least a bit */
    if (!levels_create(decoder->file, levels, blocks / 8, decoder->err)) return false;
    decoder->row = mem_alloc((size_t)width * (size_t)levels->channels, 1);
    jpeg_start_decompress(jpeg);
    read_rows(decoder, levels, orientation);
    jpeg_finish_decompress(jpeg);
    return true;
}

bool levels_read_jpeg(const ImageBytes *file, Levels *levels, Error *err)
{
    Decoder *decoder = mem_alloc(1, sizeof *decoder);
    decoder->file = file;
    decoder->err = err;
    decoder->jpeg.err = jpeg_std_error(&decoder->errors);
    decoder->errors.error_exit = stop;
    decoder->errors.emit_message = hear_warning;
    decoder->progress.progress_monitor = check_scans;
    *levels = (Levels){0};
    bool ok = false;
    if (setjmp(decoder->failed) == 0) {
        jpeg_create_decompress(&decoder->jpeg);
        decoder->jpeg.progress = &decoder->progress;
        ok = decode(decoder, levels);
    }
    jpeg_destroy_decompress(&decoder->jpeg);
    mem_free(decoder->row);
    mem_free(decoder);
    if (ok) return true;
    mem_free(levels->level);
    *levels = (Levels){0};
    return false;
}
