/* fuzz_image.c - libFuzzer: any bytes are either a PGM, PPM or JPEG with levels 0..1 or refused with a
 * sentence. */
#include "io/image.h"
#include <assert.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t length);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t length)
{
    Image image;
    Error err = {""};
    if (!image_parse("fuzz.image", bytes, length, &image, &err)) {
        assert(err.text[0] && !image.grey);
        return 0;
    }
    for (size_t i = 0; i < (size_t)image.width * (size_t)image.height; i++)
        assert(image.grey[i] >= 0 && image.grey[i] <= 1);
    double middle = image_sample(&image, 0.5, 0.5);
    assert(middle >= 0 && middle <= 1);
    image_clear(&image);
    return 0;
}
