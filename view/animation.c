#include "view/animation.h"
#include "base/memory.h"
#include "io/mark.h"
#include "io/safe_file.h"
#include <math.h>
#include <string.h>
#include <strings.h>
#include <webp/encode.h>
#include <webp/mux.h>

struct Animation {
    char *path;
    WebPAnimEncoder *encoder; /* from the first page on */
    WebPConfig config;
    double seconds; /* when the next page begins */
};

bool animation_check_path(const char *path, Error *err)
{
    const char *ending = strrchr(path, '.');
    return (ending && !strcasecmp(ending, ".webp")) ||
           error_set(err, "%s: animations are written as .webp; give the file this ending", path);
}

Animation *animation_create(const char *path, Error *err)
{
    if (!animation_check_path(path, err)) return NULL;
    Animation *animation = mem_alloc(1, sizeof *animation);
    animation->path = mem_text(path);
    WebPConfigPreset(&animation->config, WEBP_PRESET_DRAWING, 75);
    animation->config.method = 2; /* a third of the time of the best, a few percent larger */
    return animation;
}

void animation_destroy(Animation *animation)
{
    if (!animation) return;
    WebPAnimEncoderDelete(animation->encoder);
    mem_free(animation->path);
    mem_free(animation);
}

static int milliseconds(const Animation *animation)
{
    return (int)lround(1000 * animation->seconds);
}

bool animation_add(Animation *animation, Canvas *page, double seconds, Error *err)
{
    int width, height, stride;
    const unsigned char *pixels = canvas_pixels(page, &width, &height, &stride);
    if (!animation->encoder) {
        WebPAnimEncoderOptions options;
        WebPAnimEncoderOptionsInit(&options);
        options.anim_params.bgcolor = 0xffffffff;
        options.kmin = 9, options.kmax = 17;
        animation->encoder = WebPAnimEncoderNew(width, height, &options);
        if (!animation->encoder) mem_exhausted("libwebp");
    }
    WebPPicture picture;
    WebPPictureInit(&picture);
    picture.width = width, picture.height = height, picture.use_argb = 1;
    bool ok = WebPPictureImportBGRX(&picture, pixels, stride) &&
              WebPAnimEncoderAdd(animation->encoder, &picture, milliseconds(animation), &animation->config);
    if (picture.error_code == VP8_ENC_ERROR_OUT_OF_MEMORY) mem_exhausted("libwebp");
    WebPPictureFree(&picture);
    if (!ok)
        return error_set(err, "%s: a page of %d x %d pixels cannot be encoded: %s", animation->path, width,
                         height, WebPAnimEncoderGetError(animation->encoder));
    animation->seconds += seconds;
    return true;
}

/* What it says of who has made it. */
static const char mark[] = "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
                           "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"
                           "<rdf:Description xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" " MARK_WEBP(
                               SLENDER_VERSION) "/></rdf:RDF></x:xmpmeta>";

/* Source: Adobe XMP 1.2; the WebP container has it as a chunk of its own. */
static bool add_mark(WebPData *data)
{
    WebPData xmp = {(const uint8_t *)mark, sizeof mark - 1}, whole = {0};
    WebPMux *mux = WebPMuxCreate(data, 0);
    bool ok = mux && WebPMuxSetChunk(mux, "XMP ", &xmp, 0) == WEBP_MUX_OK &&
              WebPMuxAssemble(mux, &whole) == WEBP_MUX_OK;
    WebPMuxDelete(mux);
    WebPDataClear(data);
    *data = whole;
    return ok;
}

bool animation_save(Animation *animation, Error *err)
{
    WebPData data = {0};
    bool ok = animation->encoder &&
              WebPAnimEncoderAdd(animation->encoder, NULL, milliseconds(animation), NULL) &&
              WebPAnimEncoderAssemble(animation->encoder, &data) && add_mark(&data);
    ok = ok || error_set(err, "%s: the animation cannot be put together", animation->path);
    ok = ok && safe_file_write(animation->path, data.bytes, data.size, false, err);
    WebPDataClear(&data);
    return ok;
}
