/* Files and what is written to them. Every return value is checked: HDF5 reports a full disk as late as the
 * close of a dataset, and a file that is not checked may be wrong without an error. */
#include "io/hdf5_private.h"
#include "base/memory.h"
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

struct Hdf5Rows {
    hid_t dataset;
    int rank;
    hsize_t dims[3], chunk[3]; /* so far, and of a chunk */
};

enum { IMAGE_STEP = 1 << 20 };

bool hdf5_failed(const char *what, const char *path, Error *err)
{
    return error_set(err, "HDF5 cannot %s %s", what, path);
}

/* ---- Files ---- */

static Hdf5 *wrap(hid_t file)
{
    if (file < 0) return NULL;
    Hdf5 *r = mem_alloc(1, sizeof *r);
    r->file = file;
    r->size = SIZE_MAX;
    r->links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(r->links, 1);
    return r;
}

static hid_t memory_access(void)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* sentences are ours */
    H5PLset_loading_state(0);
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, IMAGE_STEP, 0);
    return access;
}

/* The core driver opens no image under the name of a file that exists, reads a file of that name before it makes
 * an image, and takes two open images of one name for the same. So each has a number of its own, in a place below a
 * file, where nothing can be. */
static const char *image_name(char name[48])
{
    static atomic_long images;
    snprintf(name, 48, "/dev/null/slender-%ld", atomic_fetch_add(&images, 1));
    return name;
}

Hdf5 *hdf5_create(void)
{
    char name[48];
    hid_t access = memory_access();
    Hdf5 *file = wrap(H5Fcreate(image_name(name), H5F_ACC_TRUNC, H5P_DEFAULT, access));
    H5Pclose(access);
    return file;
}

Hdf5 *hdf5_open(const void *bytes, size_t size, Error *err)
{
    char name[48];
    hid_t access = memory_access();
    void *copy = size ? mem_copy(bytes, size, 1) : NULL;
    bool ok = size && H5Pset_file_image(access, copy, size) >= 0;
    if (size && !ok) mem_exhausted("HDF5"); /* it copies, and nothing else */
    mem_free(copy);
    Hdf5 *file = ok ? wrap(H5Fopen(image_name(name), H5F_ACC_RDONLY, access)) : NULL;
    H5Pclose(access);
    if (!file) return error_set(err, "it is no HDF5 file"), NULL;
    file->size = size;
    return file;
}

void hdf5_close(Hdf5 *file)
{
    if (!file) return;
    H5Pclose(file->links);
    H5Fclose(file->file);
    mem_free(file);
}

bool hdf5_image(Hdf5 *file, void **bytes, size_t *size, Error *err)
{
    *bytes = NULL;
    if (H5Fflush(file->file, H5F_SCOPE_GLOBAL) < 0) return hdf5_failed("finish", "the file", err);
    ssize_t length = H5Fget_file_image(file->file, NULL, 0);
    if (length <= 0) return hdf5_failed("finish", "the file", err);
    *bytes = mem_alloc((size_t)length, 1);
    *size = (size_t)length;
    if (H5Fget_file_image(file->file, *bytes, *size) == length) return true;
    mem_free(*bytes);
    *bytes = NULL;
    return hdf5_failed("finish", "the file", err);
}

/* ---- Writing ---- */

static bool put_text_attribute(hid_t object, const char *name, const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    size_t length = strlen(text);
    H5Tset_size(type, length ? length : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD); /* VTKHDF compares the type's bytes: no closing 0 among them */
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool ok = attribute >= 0 && H5Awrite(attribute, type, length ? text : "\0") >= 0;
    ok = attribute >= 0 && H5Aclose(attribute) >= 0 && ok;
    H5Sclose(space);
    H5Tclose(type);
    return ok;
}

/* Properties of a new dataset: no times, so that the same content gives the same bytes. */
static hid_t creation(int rank, const hsize_t *dims, int chunk_rows)
{
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, 0);
    bool empty = false;
    hsize_t chunk[ARRAY_MAX_RANK];
    for (int r = 0; r < rank; r++) chunk[r] = dims[r], empty |= dims[r] == 0;
    if (chunk_rows <= 0 || rank == 0) return properties;
    chunk[0] = (hsize_t)chunk_rows;
    if (rank > 1 && empty) return properties;
    H5Pset_chunk(properties, rank, chunk);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, 1);
    return properties;
}

static hid_t file_type(const Array *array, Hdf5Layout layout)
{
    if (array->type == ARRAY_FLOAT64) return layout.single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    return layout.wide ? H5T_STD_I64LE : layout.bytes ? H5T_STD_U8LE : H5T_STD_I32LE;
}

static bool write_text(Hdf5 *file, const char *path, const Array *array)
{
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR), properties = creation(0, NULL, 0);
    size_t length = array_bytes(array);
    H5Tset_size(type, length ? length : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    hid_t dataset = H5Dcreate2(file->file, path, type, space, file->links, properties, H5P_DEFAULT);
    bool ok = dataset >= 0 &&
              H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, length ? array->data : "\0") >= 0;
    ok = dataset >= 0 && H5Dclose(dataset) >= 0 && ok;
    H5Pclose(properties);
    H5Sclose(space);
    H5Tclose(type);
    return ok;
}

static bool write_numbers(Hdf5 *file, const char *path, const Array *array, Hdf5Layout layout)
{
    hsize_t dims[ARRAY_MAX_RANK];
    for (int r = 0; r < array->rank; r++) dims[r] = (hsize_t)array->dims[r];
    hid_t space = array->rank ? H5Screate_simple(array->rank, dims, NULL) : H5Screate(H5S_SCALAR);
    hid_t properties = creation(array->rank, dims, layout.chunk_rows);
    hid_t memory = array->type == ARRAY_FLOAT64 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT32;
    hid_t dataset =
        H5Dcreate2(file->file, path, file_type(array, layout), space, file->links, properties, H5P_DEFAULT);
    bool ok = dataset >= 0 && H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, array->data) >= 0;
    const char *unit = array->unit ? array->unit : "";
    if (unit[0] || array->type == ARRAY_FLOAT64) ok = ok && put_text_attribute(dataset, "unit", unit);
    ok = dataset >= 0 && H5Dclose(dataset) >= 0 && ok;
    H5Pclose(properties);
    H5Sclose(space);
    return ok;
}

bool hdf5_write(Hdf5 *file, const char *path, const Array *array, Hdf5Layout layout, Error *err)
{
    bool ok =
        array->type == ARRAY_TEXT ? write_text(file, path, array) : write_numbers(file, path, array, layout);
    return ok || hdf5_failed("write", path, err);
}

Hdf5Rows *hdf5_rows_create(Hdf5 *file, const char *path, const char *unit, int chunk_rows, int width,
                           bool stacked, bool single, Error *err)
{
    Hdf5Rows *rows = mem_alloc(1, sizeof *rows);
    hsize_t n = (hsize_t)chunk_rows, m = (hsize_t)width;
    *rows = stacked ? (Hdf5Rows){.rank = 3, .dims = {0, n, m}, .chunk = {1, n, m}}
                    : (Hdf5Rows){.rank = width ? 2 : 1, .dims = {0, m}, .chunk = {n, m}};
    hsize_t most[3] = {H5S_UNLIMITED, rows->dims[1], rows->dims[2]};
    hid_t space = H5Screate_simple(rows->rank, rows->dims, most), properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, 0);
    H5Pset_chunk(properties, rows->rank, rows->chunk);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, 1);
    rows->dataset = H5Dcreate2(file->file, path, single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE, space, file->links,
                               properties, H5P_DEFAULT);
    H5Pclose(properties);
    H5Sclose(space);
    if (rows->dataset >= 0 && put_text_attribute(rows->dataset, "unit", unit)) return rows;
    if (rows->dataset >= 0) H5Dclose(rows->dataset);
    mem_free(rows);
    hdf5_failed("write", path, err);
    return NULL;
}

bool hdf5_rows_append(Hdf5Rows *rows, const double *values, Error *err)
{
    hsize_t first[3] = {rows->dims[0]};
    rows->dims[0] += rows->chunk[0];
    if (H5Dset_extent(rows->dataset, rows->dims) < 0) return hdf5_failed("write", "a frame", err);
    hid_t space = H5Dget_space(rows->dataset), memory = H5Screate_simple(rows->rank, rows->chunk, NULL);
    bool ok = H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, rows->chunk, NULL) >= 0 &&
              H5Dwrite(rows->dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values) >= 0;
    H5Sclose(space);
    H5Sclose(memory);
    return ok || hdf5_failed("write", "a frame", err);
}

bool hdf5_rows_close(Hdf5Rows *rows, Error *err)
{
    if (!rows) return true;
    bool ok = H5Dclose(rows->dataset) >= 0;
    mem_free(rows);
    return ok || hdf5_failed("finish", "the frames", err);
}

/* The group, made where it is missing. */
static hid_t open_group(Hdf5 *file, const char *path)
{
    if (hdf5_has(file, path)) return H5Gopen2(file->file, path, H5P_DEFAULT);
    return H5Gcreate2(file->file, path, file->links, H5P_DEFAULT, H5P_DEFAULT);
}

bool hdf5_attribute_text(Hdf5 *file, const char *group, const char *name, const char *text, Error *err)
{
    hid_t object = open_group(file, group);
    bool ok = object >= 0 && put_text_attribute(object, name, text);
    if (object >= 0) H5Gclose(object);
    return ok || hdf5_failed("write", name, err);
}

bool hdf5_attribute_ints(Hdf5 *file, const char *group, const char *name, const int *values, int count,
                         Error *err)
{
    hsize_t dims[1] = {(hsize_t)count};
    hid_t object = open_group(file, group),
          space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, dims, NULL);
    hid_t attribute =
        object >= 0 ? H5Acreate2(object, name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT) : -1;
    bool ok = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT32, values) >= 0;
    ok = attribute >= 0 && H5Aclose(attribute) >= 0 && ok;
    H5Sclose(space);
    if (object >= 0) H5Gclose(object);
    return ok || hdf5_failed("write", name, err);
}

const char *hdf5_version(void)
{
    static _Thread_local char text[32];
    unsigned major, minor, release;
    H5get_libversion(&major, &minor, &release);
    snprintf(text, sizeof text, "%u.%u.%u", major, minor, release);
    return text;
}
