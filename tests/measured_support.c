/* measured_support.c: see measured_support.h. */
#include "measured_support.h"

static const double PI = 3.14159265358979323846;

void put_le(unsigned char *p, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        p[i] = (unsigned char)(value >> (8 * i));
}

void put_float(unsigned char *p, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_le(p, bits, 4);
}

void put_double(unsigned char *p, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_le(p, bits, 8);
}

/* ---- Tensor files ---------------------------------------------------------------------------- */

enum { MAX_ELEMENTS = 2048, TYPE_U8 = 1, TYPE_U32 = 5, TYPE_F32 = 10 };

typedef struct test_field {
    const char *name;
    int type, dims;
    uint64_t shape[5];
} test_field;

static size_t type_size(int type)
{
    return type == TYPE_U8 ? 1 : 4;
}

static size_t element_count(const test_field *field)
{
    size_t count = 1;
    for (int axis = 0; axis < field->dims; axis++)
        count *= (size_t)field->shape[axis];
    return count;
}

static size_t record_size(const test_field *field)
{
    return 2 + strlen(field->name) + 2 + 1 + 8 + 8 * (size_t)field->dims;
}

/* The formulas of the synthetic RGL files; index holds p, t, then the rest of the axes. */
static double formula(const char *name, const uint64_t *index, test_circle circle)
{
    static const double first[] = {0.0, -1.0, -1.0, -1.0}, last[] = {0.0, 1.0, 0.0, -0.5};
    static const double theta[] = {0.0, 0.8, 1.57079632679489662};
    uint64_t p = index[0], t = index[1];
    if (strcmp(name, "phi_i") == 0)
        return PI * (first[circle] + (last[circle] - first[circle]) * (double)index[0] / 4);
    if (strcmp(name, "theta_i") == 0)
        return theta[index[0]];
    if (strcmp(name, "sigma") == 0)
        return 1 - 0.15 * (double)index[1] + 0.05 * (double)index[0];
    if (strcmp(name, "ndf") == 0)
        return 1 + (double)index[1] + 0.25 * (double)index[0];
    if (strcmp(name, "vndf") == 0)
        return 1 + (double)((3 * p + 5 * t + 2 * index[3] + 7 * index[2]) % 11);
    if (strcmp(name, "luminance") == 0)
        return 1 + (double)((2 * p + 3 * t + 5 * index[3] + index[2]) % 7);
    if (strcmp(name, "wavelengths") == 0)
        return 400.0 + 100.0 * (double)index[0];
    if (strcmp(name, "rgb") == 0 || strcmp(name, "spectra") == 0)
        return 0.05 * (double)(1 + (p + 2 * t + 3 * index[2] + 5 * index[4] + 7 * index[3]) % 13) -
               0.1;
    return 1.0; /* jacobian and the fields that are not read */
}

static void put_field(unsigned char *p, const test_field *field, test_circle circle)
{
    uint64_t index[5] = {0};
    for (size_t i = 0, count = element_count(field); i < count; i++) {
        double value = formula(field->name, index, circle);
        if (field->type == TYPE_F32)
            put_float(p + 4 * i, (float)value);
        else
            put_le(p + i * type_size(field->type), (uint64_t)value, (int)type_size(field->type));
        for (int axis = field->dims - 1; axis >= 0 && ++index[axis] == field->shape[axis]; axis--)
            index[axis] = 0;
    }
}

/* Without fields of rank 0: they are not asked for. */
static test_bytes make_file(test_circle circle, int rgb, int spectra)
{
    uint64_t p = circle == TEST_ISOTROPIC ? 1 : 5;
    const test_field wanted[] = {
        {"description", TYPE_U8, 1, {7}},
        {"theta_i", TYPE_F32, 1, {3}},
        {"phi_i", TYPE_F32, 1, {p}},
        {"ndf", TYPE_F32, 2, {3, 5}},
        {"sigma", TYPE_F32, 2, {3, 4}},
        {"vndf", TYPE_F32, 4, {p, 3, 6, 5}},
        {"luminance", TYPE_F32, 4, {p, 3, 4, 4}},
        {"rgb", TYPE_F32, rgb ? 5 : 0, {p, 3, 3, 4, 4}},
        {"spectra", TYPE_F32, spectra ? 5 : 0, {p, 3, 4, 4, 4}},
        {"wavelengths", TYPE_F32, spectra ? 1 : 0, {4}},
        {"jacobian", TYPE_U8, 1, {1}},
        {"version", TYPE_U32, 1, {2}},
        {"spare", TYPE_U8, 1, {3}},
    };
    test_field fields[sizeof wanted / sizeof wanted[0]];
    size_t count = 0, header = 18;
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++)
        if (wanted[i].dims > 0)
            fields[count++] = wanted[i];
    for (size_t i = 0; i < count; i++)
        header += record_size(&fields[i]);
    size_t size = (header + 7) / 8 * 8;
    for (size_t i = 0; i < count; i++)
        size += (element_count(&fields[i]) * type_size(fields[i].type) + 7) / 8 * 8;

    test_bytes file = {calloc(1, size), size};
    assert_non_null(file.data);
    memcpy(file.data, "tensor_file\0\1\0", 14);
    put_le(file.data + 14, count, 4);
    unsigned char *record = file.data + 18;
    size_t at = (header + 7) / 8 * 8;
    for (size_t i = 0; i < count; i++) {
        const test_field *field = &fields[i];
        size_t length = strlen(field->name);
        put_le(record, length, 2);
        memcpy(record + 2, field->name, length);
        put_le(record + 2 + length, (uint64_t)field->dims, 2);
        put_le(record + 4 + length, (uint64_t)field->type, 1);
        put_le(record + 5 + length, at, 8);
        for (int axis = 0; axis < field->dims; axis++)
            put_le(record + 13 + length + 8 * (size_t)axis, field->shape[axis], 8);
        put_field(file.data + at, field, circle);
        record += record_size(field);
        at += (element_count(field) * type_size(field->type) + 7) / 8 * 8;
    }
    return file;
}

test_bytes test_rgl(test_circle circle)
{
    return make_file(circle, 1, 0);
}

test_bytes test_rgl_spectral(int with_rgb)
{
    return make_file(TEST_WHOLE, with_rgb, 1);
}

size_t test_record(const test_bytes *file, const char *field)
{
    size_t length = strlen(field);
    for (size_t at = 18; at + 2 + length < file->size; at++)
        if (file->data[at] == length && file->data[at + 1] == 0 &&
            memcmp(file->data + at + 2, field, length) == 0)
            return at;
    fail_msg("the test's file has no field %s", field);
    return 0;
}

size_t test_type_at(const test_bytes *file, const char *field)
{
    return test_record(file, field) + 4 + strlen(field);
}

size_t test_offset_at(const test_bytes *file, const char *field)
{
    return test_type_at(file, field) + 1;
}

size_t test_shape_at(const test_bytes *file, const char *field, int axis)
{
    return test_type_at(file, field) + 9 + 8 * (size_t)axis;
}

size_t test_data_at(const test_bytes *file, const char *field)
{
    const unsigned char *p = file->data + test_offset_at(file, field);
    return (size_t)(p[0] | p[1] << 8 | p[2] << 16);
}

/* ---- Outcomes -------------------------------------------------------------------------------- */

static const char PATH[] = "folder/broken_rgb.bsdf";

/* A copy of exactly this size, so that a sanitizer sees every read beyond it. */
static hnbrdf_result open_exact(const void *data, size_t size, const char *path,
                                const hnbrdf_measured_options *options, hnbrdf_measured **measured,
                                hnbrdf_error *error)
{
    unsigned char *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    if (size)
        memcpy(copy, data, size);
    hnbrdf_result result = hnbrdf_measured_open_memory(copy, size, path, options, measured, error);
    free(copy);
    return result;
}

static void check_message(const hnbrdf_error *error)
{
    if (!strstr(error->text, "broken_rgb.bsdf: ") || strpbrk(error->text, "\r\n"))
        fail_msg("not one line naming the file: %s", error->text);
}

void expect_refusal(const void *data, size_t size, hnbrdf_result result, const char *words)
{
    hnbrdf_error error = {""};
    hnbrdf_measured *untouched = (hnbrdf_measured *)&error, *measured = untouched;
    hnbrdf_result found = open_exact(data, size, PATH, NULL, &measured, &error);
    if (found != result)
        fail_msg("result %d, expected %d (%s): %s", (int)found, (int)result, words, error.text);
    assert_ptr_equal(measured, untouched);
    check_message(&error);
    if (!strstr(error.text, words))
        fail_msg("no \"%s\" in: %s", words, error.text);
}

hnbrdf_measured *expect_opens(const void *data, size_t size, const char *path)
{
    return expect_opens_with(data, size, path, NULL);
}

hnbrdf_measured *expect_opens_with(const void *data, size_t size, const char *path,
                                   const hnbrdf_measured_options *options)
{
    hnbrdf_error error = {""};
    hnbrdf_measured *measured = NULL;
    if (open_exact(data, size, path, options, &measured, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
    return measured;
}

void expect_sane(const void *data, size_t size)
{
    expect_sane_with(data, size, PATH, NULL);
}

void expect_sane_with(const void *data, size_t size, const char *path,
                      const hnbrdf_measured_options *options)
{
    hnbrdf_error error = {""};
    hnbrdf_measured *measured = NULL;
    float lowest = options && options->rgl_signed ? -HNBRDF_MAX_VALUE : 0.0f;
    if (open_exact(data, size, path, options, &measured, &error) != HNBRDF_OK) {
        assert_null(measured);
        if (!strstr(error.text, path) || strpbrk(error.text, "\r\n"))
            fail_msg("not one line naming the file: %s", error.text);
        return;
    }
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 7, 7);
    for (int i = 0; i < 16; i++) {
        float wi[3], wo[3], f[3], spectrum[2];
        hnbrdf_sampler_draw((hnbrdf_sampler)(i % 3), &rng, wi, wo);
        hnbrdf_measured_eval(measured, wi, wo, f);
        for (int c = 0; c < 3; c++)
            assert_true(f[c] >= lowest && f[c] <= HNBRDF_MAX_VALUE);
        hnbrdf_measured_eval_spectrum(measured, wi, wo, 2, (float[2]){450.0f, 1e30f}, spectrum);
        for (int c = 0; c < 2; c++)
            assert_true(fabsf(spectrum[c]) <= HNBRDF_MAX_VALUE);
    }
    hnbrdf_measured_close(measured);
}

/* ---- Directions ------------------------------------------------------------------------------ */

static void direction(double theta, double phi, float w[3])
{
    w[0] = (float)(sin(theta) * cos(phi));
    w[1] = (float)(sin(theta) * sin(phi));
    w[2] = (float)cos(theta);
}

int eval_angles(const hnbrdf_measured *measured, const double angles[4], float f[3])
{
    float wi[3], wo[3];
    direction(angles[0], angles[1], wi);
    direction(angles[2], angles[3], wo);
    return hnbrdf_measured_eval(measured, wi, wo, f);
}

int pair_at(double theta_h, double theta_d, double phi_d, double phi_h, float wi[3], float wo[3])
{
    double a = cos(theta_h) * cos(theta_d), b = sin(theta_h) * sin(theta_d) * cos(phi_d);
    double c = sin(theta_h) * cos(theta_d), d = cos(theta_h) * sin(theta_d) * cos(phi_d);
    double e = sin(theta_d) * sin(phi_d), cp = cos(phi_h), sp = sin(phi_h);
    double i[3] = {c + d, e, a - b}, o[3] = {c - d, -e, a + b};
    wi[0] = (float)(cp * i[0] - sp * i[1]);
    wi[1] = (float)(sp * i[0] + cp * i[1]);
    wi[2] = (float)i[2];
    wo[0] = (float)(cp * o[0] - sp * o[1]);
    wo[1] = (float)(sp * o[0] + cp * o[1]);
    wo[2] = (float)o[2];
    return wi[2] > 0.0f && wo[2] > 0.0f;
}

void directional_albedo(const hnbrdf_measured *measured, int rings, double theta, double phi,
                        double albedo[3])
{
    enum { STEPS = 180 };
    static const double pi = 3.14159265358979323846;
    double wo[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
    float to[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
    albedo[0] = albedo[1] = albedo[2] = 0.0;
    for (int r = 0; r < rings; r++)
        for (int s = 0; s < STEPS; s++) {
            double u = (r + 0.5) / rings, theta_h = pi / 2 * u * u * u * u,
                   phi_h = 2 * pi * (s + 0.5) / STEPS;
            double h[3] = {sin(theta_h) * cos(phi_h), sin(theta_h) * sin(phi_h), cos(theta_h)};
            double c = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2],
                   weight = pi / 2 * 4 * u * u * u / rings;
            float wi[3], f[3];
            for (int i = 0; i < 3; i++)
                wi[i] = (float)(2 * c * h[i] - wo[i]);
            if (c <= 0.0 || !hnbrdf_measured_eval(measured, wi, to, f))
                continue;
            for (int i = 0; i < 3; i++)
                albedo[i] +=
                    (double)f[i] * (double)wi[2] * 4 * c * sin(theta_h) * weight * 2 * pi / STEPS;
        }
}

void assert_reciprocal(const hnbrdf_measured *measured, uint64_t stream, int pairs)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, stream);
    for (int k = 0; k < pairs; k++) {
        float wi[3], wo[3], f[3], swapped[3];
        hnbrdf_sampler_draw((hnbrdf_sampler)(k % 3), &rng, wi, wo);
        assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
        assert_int_equal(hnbrdf_measured_eval(measured, wo, wi, swapped), 1);
        assert_memory_equal(f, swapped, sizeof f);
    }
}
