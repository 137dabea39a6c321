/* What is read of HDF5 files.
 *
 * Anyone can make a file whose check sum fits. So nothing is read before its class, shape and size are known to be as
 * slender writes them; links that lead elsewhere, other files' data and code of plugins are not followed. */
#include "io/hdf5_private.h"
#include "base/memory.h"
#include <limits.h>
#include <math.h>
#include <string.h>

enum { PATH_MAX_BYTES = 512, DEPTH_MAX = 8, NAMES_MAX = 100000 };

/* Bytes that deflate makes of one, at most. */
static const double DEFLATE_MOST = 1040;

/* Bytes that may have been left at their fill value, which takes no room in the file. */
static const double FILL_MOST = 64e6;

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
    return here && stored <= file->size && bytes <= fmax(DEFLATE_MOST * (double)stored, FILL_MOST);
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

/* The attribute `unit`, or by others' word `units`; "" where there is none. NULL: it is there and no text. */
static char *read_unit(const Hdf5 *file, hid_t dataset)
{
    const char *name = H5Aexists(dataset, "unit") > 0 ? "unit" : "units";
    return H5Aexists(dataset, name) > 0 ? attribute_text(file, dataset, name) : mem_text("");
}

/* Code of plugins is not loaded: these are what HDF5 was built with. */
static bool has_filters(hid_t dataset)
{
    hid_t properties = H5Dget_create_plist(dataset);
    bool has = true;
    for (int k = 0; k < H5Pget_nfilters(properties); k++) {
        unsigned flags, config;
        size_t values = 0;
        H5Z_filter_t filter =
            H5Pget_filter2(properties, (unsigned)k, &flags, &values, NULL, 0, NULL, &config);
        has = has && H5Zfilter_avail(filter) > 0;
    }
    H5Pclose(properties);
    return has;
}

/* Texts as they are; numbers of up to 8 bytes, those rows of them. */
static bool read_values(const Hdf5 *file, hid_t dataset, int first, int count, Array *array)
{
    hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    H5T_class_t class = H5Tget_class(type);
    bool number = (class == H5T_INTEGER || class == H5T_FLOAT) && H5Tget_size(type) <= 8;
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

static bool read_dataset(const Hdf5 *file, hid_t dataset, int first, int count, Array *array, Error *err)
{
    array->unit = read_unit(file, dataset);
    if (!array->unit) return error_set(err, "the unit of %s is no text", array->name);
    if (read_values(file, dataset, first, count, array)) return true;
    return error_set(
        err,
        has_filters(dataset)
            ? "%s cannot be read: it is no array of numbers of up to three dimensions, and no text"
            : "%s is compressed by a filter that this HDF5 has not",
        array->name);
}

bool hdf5_read(Hdf5 *file, const char *path, int first, int count, Array *array, Error *err)
{
    *array = (Array){0};
    if (!hdf5_has(file, path)) return error_set(err, "there is no dataset %s", path);
    hid_t dataset = H5Dopen2(file->file, path, H5P_DEFAULT);
    if (dataset < 0) return error_set(err, "%s is no dataset", path);
    array->name = mem_text(path);
    bool ok = read_dataset(file, dataset, first, count, array, err);
    H5Dclose(dataset);
    if (!ok) array_clear(array);
    return ok;
}

bool hdf5_read_attribute_text(Hdf5 *file, const char *group, const char *name, char **text, Error *err)
{
    *text = NULL;
    hid_t object = hdf5_has(file, group) ? H5Gopen2(file->file, group, H5P_DEFAULT) : -1;
    if (object < 0) return hdf5_failed("read", group, err);
    *text = attribute_text(file, object, name);
    H5Gclose(object);
    return *text || hdf5_failed("read", name, err);
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
