/* The only file that includes hdf5.h. Every return value is checked: HDF5 reports a full disk as late as the
 * close of a dataset, and a file that is not checked may be wrong without an error. */
#include "io/hdf5_file.h"
#include "base/memory.h"
#include <hdf5.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

struct Hdf5 {
    hid_t file, links; /* links: makes the groups on the way        */
    size_t size;       /* bytes of one that is read: nothing in it is larger */
};

struct Hdf5Rows {
    hid_t dataset;
    int rank;
    hsize_t dims[3], chunk[3]; /* so far, and of a chunk */
};

enum { IMAGE_STEP = 1 << 20, PATH_MAX_BYTES = 512, DEPTH_MAX = 8, NAMES_MAX = 100000 };

/* Bytes that deflate makes of one, at most. */
static const double DEFLATE_MOST = 1040;

static bool failed(const char *what, const char *path, Error *err)
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
    if (H5Fflush(file->file, H5F_SCOPE_GLOBAL) < 0) return failed("finish", "the file", err);
    ssize_t length = H5Fget_file_image(file->file, NULL, 0);
    if (length <= 0) return failed("finish", "the file", err);
    *bytes = mem_alloc((size_t)length, 1);
    *size = (size_t)length;
    if (H5Fget_file_image(file->file, *bytes, *size) == length) return true;
    mem_free(*bytes);
    *bytes = NULL;
    return failed("finish", "the file", err);
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
    return ok || failed("write", path, err);
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
    failed("write", path, err);
    return NULL;
}

bool hdf5_rows_append(Hdf5Rows *rows, const double *values, Error *err)
{
    hsize_t first[3] = {rows->dims[0]};
    rows->dims[0] += rows->chunk[0];
    if (H5Dset_extent(rows->dataset, rows->dims) < 0) return failed("write", "a frame", err);
    hid_t space = H5Dget_space(rows->dataset), memory = H5Screate_simple(rows->rank, rows->chunk, NULL);
    bool ok = H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, rows->chunk, NULL) >= 0 &&
              H5Dwrite(rows->dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values) >= 0;
    H5Sclose(space);
    H5Sclose(memory);
    return ok || failed("write", "a frame", err);
}

bool hdf5_rows_close(Hdf5Rows *rows, Error *err)
{
    if (!rows) return true;
    bool ok = H5Dclose(rows->dataset) >= 0;
    mem_free(rows);
    return ok || failed("finish", "the frames", err);
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
    return ok || failed("write", name, err);
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
    return ok || failed("write", name, err);
}

/* ---- Reading ----
 *
 * Anyone can make a file whose check sum fits. So nothing is read before its class, shape and size are known to be as
 * slender writes them; links that lead elsewhere, other files' data and code of plugins are not followed. */

/* H5Lexists wants every group on the way to exist. */
static bool has_link(hid_t file, const char *path)
{
    H5L_info_t info;
    return H5Lexists(file, path, H5P_DEFAULT) > 0 && H5Lget_info(file, path, &info, H5P_DEFAULT) >= 0 &&
           info.type == H5L_TYPE_HARD;
}

bool hdf5_has(Hdf5 *file, const char *path)
{
    char part[PATH_MAX_BYTES];
    for (const char *c = path; *c;) {
        while (*c == '/') c++;
        while (*c && *c != '/') c++;
        size_t length = (size_t)(c - path);
        if (!length || length >= sizeof part) return false;
        memcpy(part, path, length);
        part[length] = 0;
        if (!has_link(file->file, part)) return false;
    }
    return *path != 0;
}

/* One text of fixed length; HDF5 itself would fill a buffer with as many as there are. The type says how long. */
static bool is_one_text(const Hdf5 *file, hid_t type, hid_t space)
{
    return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
           H5Sget_simple_extent_npoints(space) == 1 && H5Tget_size(type) <= file->size;
}

/* NULL where there is none, or it is not one text; of one of no fixed length (h5py's) HDF5 allocates it. */
static char *attribute_text(const Hdf5 *file, hid_t object, const char *name)
{
    char *text = NULL, *read = NULL;
    hid_t attribute = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
    if (attribute < 0) return NULL;
    hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    if (is_one_text(file, type, space)) {
        text = mem_alloc(H5Tget_size(type) + 1, 1);
        if (H5Aread(attribute, type, text) < 0) mem_free(text), text = NULL;
    } else if (H5Tis_variable_str(type) > 0 && H5Sget_simple_extent_npoints(space) == 1) {
        if (H5Aread(attribute, type, &read) >= 0 && read) text = mem_text(read), H5free_memory(read);
    }
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
    return text;
}

/* Data that are in this file, and of a size that its bytes can have. */
static bool is_stored(const Hdf5 *file, hid_t dataset, hid_t type, hid_t space)
{
    hid_t properties = H5Dget_create_plist(dataset);
    bool here = H5Pget_external_count(properties) == 0 && H5Pget_layout(properties) != H5D_VIRTUAL;
    H5Pclose(properties);
    hsize_t stored = H5Dget_storage_size(dataset);
    double bytes = (double)H5Sget_simple_extent_npoints(space) * (double)H5Tget_size(type);
    return here && stored <= file->size && bytes <= DEFLATE_MOST * (double)stored;
}

static bool read_text(const Hdf5 *file, hid_t dataset, hid_t type, hid_t space, Array *array)
{
    if (!is_one_text(file, type, space)) return false;
    char *text = mem_alloc(H5Tget_size(type) + 1, 1);
    array->type = ARRAY_TEXT;
    array->data = text;
    if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0) return false;
    array->rank = 1;
    array->dims[0] = (int)strlen(text);
    return true;
}

/* Selects the rows and fills in the shape. */
static bool select_rows(hid_t space, int first, int count, Array *array)
{
    hsize_t dims[ARRAY_MAX_RANK] = {0}, start[ARRAY_MAX_RANK] = {(hsize_t)first};
    int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0 || rank > ARRAY_MAX_RANK || H5Sget_simple_extent_dims(space, dims, NULL) < 0) return false;
    if (count < 0) first = 0, count = rank ? (int)dims[0] : 0, start[0] = 0;
    if (rank && (first < 0 || (hsize_t)first + (hsize_t)count > dims[0])) return false;
    double total = 1;
    for (int r = 0; r < rank; r++) {
        if (dims[r] > INT_MAX) return false;
        array->dims[r] = r ? (int)dims[r] : count;
        total *= array->dims[r];
    }
    if (total > 1e10) return false;
    array->rank = rank;
    dims[0] = (hsize_t)count;
    return rank == 0 || total == 0 ||
           H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, dims, NULL) >= 0;
}

static bool narrow(const int64_t *wide, size_t count, int32_t *values)
{
    for (size_t i = 0; i < count; i++) {
        if (wide[i] > INT32_MAX || wide[i] < INT32_MIN) return false;
        values[i] = (int32_t)wide[i];
    }
    return true;
}

static bool read_numbers(hid_t dataset, hid_t type, hid_t space, Array *array)
{
    bool integer = H5Tget_class(type) == H5T_INTEGER, ok = true;
    array->type = integer ? ARRAY_INT32 : ARRAY_FLOAT64;
    size_t total = array_count(array);
    hsize_t size[1] = {total};
    hid_t memory = array->rank ? H5Screate_simple(1, size, NULL) : H5Screate(H5S_SCALAR);
    void *data = mem_alloc(total, 8);
    array->data = data;
    if (total > 0)
        ok = H5Dread(dataset, integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT,
                     data) >= 0;
    if (ok && integer) {
        array->data = mem_alloc(total, sizeof(int32_t));
        ok = narrow(data, total, (int32_t *)array->data);
        mem_free(data);
    }
    H5Sclose(memory);
    return ok;
}

/* Texts as they are; numbers of up to 8 bytes, those rows of them. */
static bool read_dataset(const Hdf5 *file, hid_t dataset, int first, int count, Array *array)
{
    hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    H5T_class_t class = H5Tget_class(type);
    bool number = (class == H5T_INTEGER || class == H5T_FLOAT) && H5Tget_size(type) <= 8;
    char *unit = attribute_text(file, dataset, "unit");
    if (!unit) unit = attribute_text(file, dataset, "units"); /* others' word */
    array->unit = unit ? unit : mem_text("");
    bool ok = is_stored(file, dataset, type, space);
    if (ok && class == H5T_STRING)
        ok = read_text(file, dataset, type, space, array);
    else
        ok = ok && number && select_rows(space, first, count, array) &&
             read_numbers(dataset, type, space, array);
    H5Sclose(space);
    H5Tclose(type);
    return ok;
}

bool hdf5_read(Hdf5 *file, const char *path, int first, int count, Array *array, Error *err)
{
    *array = (Array){0};
    if (!hdf5_has(file, path)) return error_set(err, "there is no dataset %s", path);
    hid_t dataset = H5Dopen2(file->file, path, H5P_DEFAULT);
    if (dataset < 0) return error_set(err, "%s is no dataset", path);
    array->name = mem_text(path);
    bool ok = read_dataset(file, dataset, first, count, array);
    H5Dclose(dataset);
    if (ok) return true;
    array_clear(array);
    return failed("read", path, err);
}

bool hdf5_read_attribute_text(Hdf5 *file, const char *group, const char *name, char **text, Error *err)
{
    *text = NULL;
    hid_t object = hdf5_has(file, group) ? H5Gopen2(file->file, group, H5P_DEFAULT) : -1;
    if (object < 0) return failed("read", group, err);
    *text = attribute_text(file, object, name);
    H5Gclose(object);
    return *text || failed("read", name, err);
}

/* ---- Listing ---- */

typedef struct Names {
    int count, objects;
    char *text; /* all names, one after the other; NULL: they are only counted */
    size_t used;
} Names;

/* Groups may lie in each other, and go round. */
static bool is_too_deep(const char *name)
{
    int depth = 1;
    for (const char *c = name; *c; c++) depth += *c == '/';
    return depth > DEPTH_MAX;
}

static herr_t visit(hid_t group, const char *name, const H5O_info_t *info, void *data)
{
    (void)group;
    Names *names = data;
    size_t length = strlen(name) + 1;
    if (length > PATH_MAX_BYTES || ++names->objects > NAMES_MAX || is_too_deep(name)) return -1;
    if (info->type != H5O_TYPE_DATASET) return 0;
    if (names->text) memcpy(names->text + names->used, name, length);
    names->used += length;
    names->count++;
    return 0;
}

static bool visit_all(const Hdf5 *file, Names *names)
{
    return H5Ovisit2(file->file, H5_INDEX_NAME, H5_ITER_INC, visit, names, H5O_INFO_BASIC) >= 0;
}

/* Counts first: while HDF5 calls back it holds its lock, and nothing may be allocated (base/guard.h). */
bool hdf5_list(Hdf5 *file, char ***paths, int *count, Error *err)
{
    Names names = {0};
    bool ok = visit_all(file, &names);
    char **table = mem_alloc((size_t)names.count * sizeof *table + names.used, 1),
         *text = (char *)(table + names.count);
    ok = ok && visit_all(file, &(Names){.text = text});
    for (int k = 0; ok && k < names.count; k++, text += strlen(text) + 1) table[k] = text;
    *paths = table;
    *count = names.count;
    if (ok) return true;
    mem_free(table);
    *paths = NULL;
    return error_set(err,
                     "what is in it is not as slender writes it: groups more than %d deep, names of more "
                     "than %d bytes, or "
                     "more than %d of them",
                     DEPTH_MAX, PATH_MAX_BYTES, NAMES_MAX);
}

const char *hdf5_version(void)
{
    static _Thread_local char text[32];
    unsigned major, minor, release;
    H5get_libversion(&major, &minor, &release);
    snprintf(text, sizeof text, "%u.%u.%u", major, minor, release);
    return text;
}
