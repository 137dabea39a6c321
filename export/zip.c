#include "export/zip.h"
#include "base/memory.h"
#include "io/mark.h"
#include <string.h>
#include <zlib.h>

enum {
    VERSION = 20,
    UTF8_NAMES = 1 << 11,
    DEFLATED = 8,
    DAY = 0x21 /* 1980-01-01: the same bytes at all times */
};

static const size_t LARGEST = 4000000000u; /* bytes */

/* Raw deflate. Owned by the caller. */
static unsigned char *deflated(const void *data, size_t size, size_t *packed)
{
    z_stream stream = {0};
    if (deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        mem_exhausted("zlib");
    size_t most = deflateBound(&stream, size);
    unsigned char *out = mem_alloc(most, 1);
    stream.next_in = (Bytef *)data, stream.avail_in = (uInt)size; /* zlib does not write to it */
    stream.next_out = out, stream.avail_out = (uInt)most;
    deflate(&stream, Z_FINISH);
    *packed = stream.total_out;
    deflateEnd(&stream);
    return out;
}

/* What both the member and its entry say. */
static void add_facts(Bytes *bytes, uint32_t crc, size_t packed, size_t size, const char *name)
{
    bytes_add_u16(bytes, VERSION);
    bytes_add_u16(bytes, UTF8_NAMES);
    bytes_add_u16(bytes, DEFLATED);
    bytes_add_u16(bytes, 0);
    bytes_add_u16(bytes, DAY);
    bytes_add_u32(bytes, crc);
    bytes_add_u32(bytes, (uint32_t)packed);
    bytes_add_u32(bytes, (uint32_t)size);
    bytes_add_u16(bytes, (unsigned)strlen(name));
    bytes_add_u16(bytes, 0);
}

bool zip_add(Zip *zip, const char *name, const void *data, size_t size, Error *err)
{
    if (size > LARGEST) return error_set(err, "%s has more than 4 GB, which a zip archive cannot hold", name);
    size_t packed, start = zip->file->size;
    unsigned char *bytes = deflated(data, size, &packed);
    bool fits = start + packed <= LARGEST && zip->count < UINT16_MAX;
    if (fits) {
        uint32_t crc = (uint32_t)crc32_z(0, data, size);
        bytes_add(zip->file, "PK\3\4", 4);
        add_facts(zip->file, crc, packed, size, name);
        bytes_add_text(zip->file, name);
        bytes_add(zip->file, bytes, packed);
        bytes_add(&zip->entries, "PK\1\2", 4);
        bytes_add_u16(&zip->entries, VERSION);
        add_facts(&zip->entries, crc, packed, size, name);
        for (int k = 0; k < 3; k++) bytes_add_u16(&zip->entries, 0); /* comment, disk, attributes */
        bytes_add_u32(&zip->entries, 0);
        bytes_add_u32(&zip->entries, (uint32_t)start);
        bytes_add_text(&zip->entries, name);
        zip->count++;
    }
    mem_free(bytes);
    return fits || error_set(err, "the archive would have more than 4 GB, or 65535 members");
}

void zip_end(Zip *zip)
{
    static const char comment[] = MARK_ZIP(SLENDER_VERSION);
    uint32_t start = (uint32_t)zip->file->size;
    bytes_add(zip->file, zip->entries.data, zip->entries.size);
    bytes_add(zip->file, "PK\5\6", 4);
    bytes_add_u32(zip->file, 0);
    bytes_add_u16(zip->file, zip->count);
    bytes_add_u16(zip->file, zip->count);
    bytes_add_u32(zip->file, (uint32_t)zip->entries.size);
    bytes_add_u32(zip->file, start);
    bytes_add_u16(zip->file, sizeof comment - 1);
    bytes_add_text(zip->file, comment);
    bytes_clear(&zip->entries);
}
