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
    bool ended; /* the file did, without its end marker */
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

/* libjpeg goes on with grey where data are missing; oddities that lose nothing pass. Where the file ends it
 * takes an end marker for granted: whether something is missing shows later. */
static void hear_warning(j_common_ptr jpeg, int level)
{
    int code = jpeg->err->msg_code;
    if (level >= 0) return;
    if (code == JWRN_JPEG_EOF) ((Decoder *)jpeg->err)->ended = true;
    if (code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE) stop(jpeg);
}

static void check_scans(j_common_ptr jpeg)
{
    Decoder *decoder = (Decoder *)jpeg->err;
    if (decoder->jpeg.input_scan_number <= SCANS_MAX) return;
    error_set(decoder->err, "%s: the JPEG data are broken: more than %d scans", decoder->file->path,
              SCANS_MAX);
    longjmp(decoder->failed, 1);
}

static int orientation_of(const struct jpeg_decompress_struct *jpeg)
{
    for (jpeg_saved_marker_ptr marker = jpeg->marker_list; marker; marker = marker->next)
        if (marker->data_length >= 14 && memcmp(marker->data, "Exif\0", 6) == 0)
            return levels_exif_orientation(marker->data + 6, marker->data_length - 6);
    return 1;
}

/* Of a file without its end marker: are all components there, and to the last bit? A scan that is cut short
 * is heard before. */
static bool has_all_scans(const struct jpeg_decompress_struct *jpeg)
{
    bool all = true;
    for (int c = 0; c < jpeg->num_components; c++) {
        all = all && jpeg->comp_info[c].quant_table;
        for (int k = 0; jpeg->progressive_mode && k < DCTSIZE2; k++) all = all && jpeg->coef_bits[c][k] == 0;
    }
    return all;
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
    *levels = (Levels){.width = (int)jpeg->image_width,
                       .height = (int)jpeg->image_height,
                       .channels = jpeg->num_components,
                       .maximum = 255,
                       .orientation = orientation_of(jpeg)};
    size_t blocks = (size_t)levels->width * (size_t)levels->height / 64; /* each takes at least a bit */
    if (!levels_create(decoder->file, levels, blocks / 8, decoder->err)) return false;
    decoder->row = mem_alloc((size_t)levels->width * (size_t)levels->channels, 1);
    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        int row = (int)jpeg->output_scanline;
        jpeg_read_scanlines(jpeg, &decoder->row, 1);
        levels_add_row(levels, row, decoder->row, 1);
    }
    if (decoder->ended && !has_all_scans(jpeg))
        return error_set(decoder->err, "%s: the JPEG data are broken: the file ends before its last scan",
                         decoder->file->path);
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
    mem_free(levels->sum);
    *levels = (Levels){0};
    return false;
}
