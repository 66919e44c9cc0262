/* info.c: what `hnbrdf info` tells of models and measured files, for people and as JSON. */
#include "report/info.h"

#include "base/text.h"
#include "base/write.h"
#include "report/info_physics.h"

#include <string.h>

/* ---- Models ---------------------------------------------------------------------------------- */

static const char *net_name(const hnbrdf_model_desc *desc, char text[16])
{
    if (desc->kind == HNBRDF_KIND_GGX)
        return "none";
    snprintf(text, 16, "%dx%d", desc->hidden, desc->layers);
    return text;
}

static const char *encoding_name(const hnbrdf_model_desc *desc)
{
    return desc->kind == HNBRDF_KIND_GGX ? "none" : hnbrdf_encoding_name(desc->encoding);
}

/* The row below that of an edited material. */
static const char FITTED_AS[] = "  edited; fitted as";

static void print_material(const hnbrdf_material *m, const char *name, int width, FILE *file)
{
    fprintf(file, "%-*s  %6.4f %6.4f %6.4f  %7.4g %7.4g %7.4g  %7.4g %7.4g  %8.4g\n", width, name,
            (double)m->kd[0], (double)m->kd[1], (double)m->kd[2], (double)m->eta[0],
            (double)m->eta[1], (double)m->eta[2], (double)m->alpha[0], (double)m->alpha[1],
            (double)m->rotation);
    if (hnbrdf_material_is_edited(m)) {
        const hnbrdf_fitted *f = &m->fitted;
        fprintf(file, "%-*s  %6.4f %6.4f %6.4f  %7.4g %7.4g %7.4g  %7.4g %7.4g\n", width, FITTED_AS,
                (double)f->kd[0], (double)f->kd[1], (double)f->kd[2], (double)f->eta[0],
                (double)f->eta[1], (double)f->eta[2], (double)f->alpha[0], (double)f->alpha[1]);
    }
}

void info_print_model(const char *path, const hnbrdf_model *model, const hnbrdf_physics *physics,
                      FILE *file)
{
    char net[16];
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    fprintf(file, "%s\n", path);
    fprintf(file, "  kind       %s\n", hnbrdf_kind_name(desc.kind));
    fprintf(file, "  net        %s\n", net_name(&desc, net));
    fprintf(file, "  encoding   %s\n", encoding_name(&desc));
    fprintf(file, "  latent     %d\n", desc.latent);
    fprintf(file, "  weights    %zu, shared by all materials\n", hnbrdf_model_weight_count(model));
    fprintf(file, "  mults      %zu for one evaluation\n", hnbrdf_model_multiplications(model));
    fprintf(file, "  scale      %.6g\n  shift      %.6g\n  floor      %.6g\n", (double)desc.scale,
            (double)desc.shift, (double)desc.floor);
    fprintf(file, "  materials  %d\n\n", desc.material_count);
    int width = (int)strlen("material");
    for (int k = 0; k < desc.material_count; k++) {
        const char *note = hnbrdf_material_is_edited(&desc.materials[k]) ? FITTED_AS : "";
        width = (int)strlen(desc.names[k]) > width ? (int)strlen(desc.names[k]) : width;
        width = (int)strlen(note) > width ? (int)strlen(note) : width;
    }
    fprintf(file, "%-*s  %-20s  %-23s  %-15s  %8s\n", width, "material", "kd (R G B)",
            "eta (R G B)", "alpha (x y)", "rotation");
    for (int k = 0; k < desc.material_count; k++)
        print_material(&desc.materials[k], desc.names[k], width, file);
    if (physics)
        info_print_physics(model, physics, width, file);
}

static void json_number(float value, FILE *file)
{
    char text[HNBRDF_NUMBER_TEXT];
    hnbrdf_format_float(text, sizeof text, value);
    fputs(text, file);
}

static void json_numbers(const char *key, const float *values, int count, FILE *file)
{
    fprintf(file, ", \"%s\": [", key);
    for (int k = 0; k < count; k++) {
        fputs(k ? ", " : "", file);
        json_number(values[k], file);
    }
    putc(']', file);
}

static void json_names(const char *const *names, int count, FILE *file)
{
    fputs("  \"materials\": [", file);
    for (int k = 0; k < count; k++) {
        fputs(k ? ", " : "", file);
        hnbrdf_write_json_text(file, names[k]);
    }
    fputs("],\n", file);
}

static void json_material(const hnbrdf_material *m, const hnbrdf_physics *physics, const char *name,
                          int latent, FILE *file)
{
    fputs("    {\"name\": ", file);
    hnbrdf_write_json_text(file, name);
    json_numbers("kd", m->kd, 3, file);
    json_numbers("eta", m->eta, 3, file);
    json_numbers("alpha", m->alpha, 2, file);
    fputs(", \"rotation\": ", file);
    json_number(m->rotation, file);
    json_numbers("latent", m->latent, latent, file);
    if (hnbrdf_material_is_edited(m)) {
        json_numbers("fitted_kd", m->fitted.kd, 3, file);
        json_numbers("fitted_eta", m->fitted.eta, 3, file);
        json_numbers("fitted_alpha", m->fitted.alpha, 2, file);
    }
    if (physics)
        info_json_physics(physics, file);
    putc('}', file);
}

void info_json_model(const hnbrdf_model *model, const hnbrdf_physics *physics, FILE *file)
{
    char net[16];
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    fprintf(file, "{\n  \"kind\": \"%s\",\n  \"net\": \"%s\",\n", hnbrdf_kind_name(desc.kind),
            net_name(&desc, net));
    fprintf(file, "  \"encoding\": \"%s\",\n  \"latent\": %d,\n", encoding_name(&desc),
            desc.latent);
    json_names(desc.names, desc.material_count, file);
    fprintf(file, "  \"weights\": %zu,\n  \"mults\": %zu,\n", hnbrdf_model_weight_count(model),
            hnbrdf_model_multiplications(model));
    fputs("  \"scale\": ", file);
    json_number(desc.scale, file);
    fputs(",\n  \"shift\": ", file);
    json_number(desc.shift, file);
    fputs(",\n  \"floor\": ", file);
    json_number(desc.floor, file);
    fputs(",\n  \"parameters\": [\n", file);
    for (int k = 0; k < desc.material_count; k++) {
        json_material(&desc.materials[k], physics ? &physics[k] : NULL, desc.names[k], desc.latent,
                      file);
        fputs(k + 1 < desc.material_count ? ",\n" : "\n", file);
    }
    fputs("  ]\n}\n", file);
}

/* ---- Measured -------------------------------------------------------------------------------- */

static const char *format_name(const hnbrdf_measured *measured)
{
    return hnbrdf_measured_format_name(hnbrdf_measured_format_of(measured));
}

void info_print_measured(const char *path, const hnbrdf_measured *measured, FILE *file)
{
    fprintf(file, "%s\n", path);
    fprintf(file, "  name       %s\n", hnbrdf_measured_name(measured));
    fprintf(file, "  format     %s\n", format_name(measured));
    fprintf(file, "  isotropic  %s\n", hnbrdf_measured_is_isotropic(measured) ? "yes" : "no");
    fprintf(file, "  summary    %s\n", hnbrdf_measured_summary(measured));
    if (hnbrdf_measured_format_of(measured) != HNBRDF_MEASURED_MERL)
        return;
    const char *published = hnbrdf_measured_published(measured);
    if (published)
        fprintf(file, "  checksum   known MERL file %s\n", published);
    else
        fprintf(file, "  checksum   not one of the 100 published files\n");
}

void info_json_measured(const hnbrdf_measured *measured, int identified, FILE *file)
{
    fputs("{\"kind\": \"measured\", \"format\": ", file);
    hnbrdf_write_json_text(file, format_name(measured));
    fputs(", \"name\": ", file);
    hnbrdf_write_json_text(file, hnbrdf_measured_name(measured));
    fprintf(file, ", \"isotropic\": %s", hnbrdf_measured_is_isotropic(measured) ? "true" : "false");
    fputs(", \"summary\": ", file);
    hnbrdf_write_json_text(file, hnbrdf_measured_summary(measured));
    if (identified && hnbrdf_measured_format_of(measured) == HNBRDF_MEASURED_MERL) {
        const char *published = hnbrdf_measured_published(measured);
        fputs(", \"published\": ", file);
        if (published)
            hnbrdf_write_json_text(file, published);
        else
            fputs("null", file);
    }
    putc('}', file);
}

void info_print_data(hnbrdf_measured *const *items, int count, FILE *file)
{
    int width = (int)strlen("material");
    for (int k = 0; k < count; k++) {
        int length = (int)strlen(hnbrdf_measured_name(items[k]));
        width = length > width ? length : width;
    }
    fprintf(file, "%-*s  %-7s  %-9s  %s\n", width, "material", "format", "isotropic", "summary");
    for (int k = 0; k < count; k++)
        fprintf(file, "%-*s  %-7s  %-9s  %s\n", width, hnbrdf_measured_name(items[k]),
                format_name(items[k]), hnbrdf_measured_is_isotropic(items[k]) ? "yes" : "no",
                hnbrdf_measured_summary(items[k]));
}

void info_json_data(hnbrdf_measured *const *items, int count, FILE *file)
{
    fputs("{\"kind\": \"data\", \"materials\": [", file);
    for (int k = 0; k < count; k++) {
        fputs(k ? ", " : "", file);
        hnbrdf_write_json_text(file, hnbrdf_measured_name(items[k]));
    }
    fputs("],\n \"items\": [", file);
    for (int k = 0; k < count; k++) {
        fputs(k ? ",\n  " : "\n  ", file);
        info_json_measured(items[k], 0, file);
    }
    fputs("\n]}\n", file);
}
