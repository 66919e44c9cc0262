/* cmd_info.c: `hnbrdf info`: what a model, a measured file or a collection of them holds. */
#include "cli/cli.h"
#include "report/info_physics.h"
#include "base/text.h"
#include "base/write.h"

#include <string.h>
#include <sys/stat.h>

static const cli_command command = {
    "info",
    "SOURCE [--json]",
    "Tells what SOURCE holds: a model file, a measured file, builtin:NAME,\n"
    " builtin, or a directory of measured files. The checksum of a single MERL file "
    "is compared\n"
    "with those of the 100 published ones.\n"
    "\n"
    "Weights are the numbers shared by all materials, mults the multiplications of the network for "
    "one\n"
    "evaluation. Of each material of a model also: its directional albedo (above 1 it gives off "
    "more light\n"
    "than it gets), how far it is from reciprocal, how many of its values are 0.\n"
    "JSON keys of a model: kind, net, encoding, latent, materials, weights, mults, scale, shift, "
    "floor,\n"
    "parameters; of a measured file: kind, format, name, isotropic, summary, of a single MERL file "
    "also\n"
    "published: the material's name, or null.",
    "hnbrdf info builtin\n"
    "hnbrdf info model.safetensors\n"
    "hnbrdf info alum-bronze.binary\n"
    "hnbrdf info model.safetensors --json",
};

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

static void print_material(const hnbrdf_material *m, const char *name, int width)
{
    printf("%-*s  %6.4f %6.4f %6.4f  %7.4g %7.4g %7.4g  %7.4g %7.4g  %8.4g\n", width, name,
           (double)m->kd[0], (double)m->kd[1], (double)m->kd[2], (double)m->eta[0],
           (double)m->eta[1], (double)m->eta[2], (double)m->alpha[0], (double)m->alpha[1],
           (double)m->rotation);
}

static void print_model(const char *path, const hnbrdf_model *model)
{
    char net[16];
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    printf("%s\n", path);
    printf("  kind       %s\n", hnbrdf_kind_name(desc.kind));
    printf("  net        %s\n", net_name(&desc, net));
    printf("  encoding   %s\n", encoding_name(&desc));
    printf("  latent     %d\n", desc.latent);
    printf("  weights    %zu, shared by all materials\n", hnbrdf_model_weight_count(model));
    printf("  mults      %zu for one evaluation\n", hnbrdf_model_multiplications(model));
    printf("  scale      %.6g\n  shift      %.6g\n  floor      %.6g\n", (double)desc.scale,
           (double)desc.shift, (double)desc.floor);
    printf("  materials  %d\n\n", desc.material_count);
    int width = (int)strlen("material");
    for (int k = 0; k < desc.material_count; k++)
        width = (int)strlen(desc.names[k]) > width ? (int)strlen(desc.names[k]) : width;
    printf("%-*s  %-20s  %-23s  %-15s  %8s\n", width, "material", "kd (R G B)", "eta (R G B)",
           "alpha (x y)", "rotation");
    for (int k = 0; k < desc.material_count; k++)
        print_material(&desc.materials[k], desc.names[k], width);
    info_print_physics(model, width, stdout);
}

static void json_number(float value)
{
    char text[HNBRDF_NUMBER_TEXT];
    hnbrdf_format_float(text, sizeof text, value);
    fputs(text, stdout);
}

static void json_numbers(const char *key, const float *values, int count)
{
    printf(", \"%s\": [", key);
    for (int k = 0; k < count; k++) {
        fputs(k ? ", " : "", stdout);
        json_number(values[k]);
    }
    putchar(']');
}

static void json_names(const char *const *names, int count)
{
    fputs("  \"materials\": [", stdout);
    for (int k = 0; k < count; k++) {
        fputs(k ? ", " : "", stdout);
        hnbrdf_write_json_text(stdout, names[k]);
    }
    fputs("],\n", stdout);
}

static void json_material(const hnbrdf_model *model, const hnbrdf_material *m, const char *name,
                          int latent)
{
    fputs("    {\"name\": ", stdout);
    hnbrdf_write_json_text(stdout, name);
    json_numbers("kd", m->kd, 3);
    json_numbers("eta", m->eta, 3);
    json_numbers("alpha", m->alpha, 2);
    fputs(", \"rotation\": ", stdout);
    json_number(m->rotation);
    json_numbers("latent", m->latent, latent);
    info_json_physics(model, m, stdout);
    putchar('}');
}

static void json_model(const hnbrdf_model *model)
{
    char net[16];
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    printf("{\n  \"kind\": \"%s\",\n  \"net\": \"%s\",\n", hnbrdf_kind_name(desc.kind),
           net_name(&desc, net));
    printf("  \"encoding\": \"%s\",\n  \"latent\": %d,\n", encoding_name(&desc), desc.latent);
    json_names(desc.names, desc.material_count);
    printf("  \"weights\": %zu,\n  \"mults\": %zu,\n", hnbrdf_model_weight_count(model),
           hnbrdf_model_multiplications(model));
    fputs("  \"scale\": ", stdout);
    json_number(desc.scale);
    fputs(",\n  \"shift\": ", stdout);
    json_number(desc.shift);
    fputs(",\n  \"floor\": ", stdout);
    json_number(desc.floor);
    fputs(",\n  \"parameters\": [\n", stdout);
    for (int k = 0; k < desc.material_count; k++) {
        json_material(model, &desc.materials[k], desc.names[k], desc.latent);
        fputs(k + 1 < desc.material_count ? ",\n" : "\n", stdout);
    }
    fputs("  ]\n}\n", stdout);
}

/* ---- Measured -------------------------------------------------------------------------------- */

static const char *format_name(const hnbrdf_measured *measured)
{
    return hnbrdf_measured_format_name(hnbrdf_measured_format_of(measured));
}

static void print_measured(const char *path, const hnbrdf_measured *measured)
{
    printf("%s\n", path);
    printf("  name       %s\n", hnbrdf_measured_name(measured));
    printf("  format     %s\n", format_name(measured));
    printf("  isotropic  %s\n", hnbrdf_measured_is_isotropic(measured) ? "yes" : "no");
    printf("  summary    %s\n", hnbrdf_measured_summary(measured));
    if (hnbrdf_measured_format_of(measured) != HNBRDF_MEASURED_MERL)
        return;
    const char *published = hnbrdf_measured_published(measured);
    if (published)
        printf("  checksum   known MERL file %s\n", published);
    else
        printf("  checksum   not one of the 100 published files\n");
}

static void json_measured(const hnbrdf_measured *measured)
{
    fputs("{\"kind\": \"measured\", \"format\": ", stdout);
    hnbrdf_write_json_text(stdout, format_name(measured));
    fputs(", \"name\": ", stdout);
    hnbrdf_write_json_text(stdout, hnbrdf_measured_name(measured));
    printf(", \"isotropic\": %s", hnbrdf_measured_is_isotropic(measured) ? "true" : "false");
    fputs(", \"summary\": ", stdout);
    hnbrdf_write_json_text(stdout, hnbrdf_measured_summary(measured));
    if (cli_read.merl_identify && hnbrdf_measured_format_of(measured) == HNBRDF_MEASURED_MERL) {
        const char *published = hnbrdf_measured_published(measured);
        fputs(", \"published\": ", stdout);
        if (published)
            hnbrdf_write_json_text(stdout, published);
        else
            fputs("null", stdout);
    }
    putchar('}');
}

static void print_data(const cli_data *data)
{
    int width = (int)strlen("material");
    for (int k = 0; k < data->count; k++) {
        int length = (int)strlen(hnbrdf_measured_name(data->items[k]));
        width = length > width ? length : width;
    }
    printf("%-*s  %-7s  %-9s  %s\n", width, "material", "format", "isotropic", "summary");
    for (int k = 0; k < data->count; k++)
        printf("%-*s  %-7s  %-9s  %s\n", width, hnbrdf_measured_name(data->items[k]),
               format_name(data->items[k]),
               hnbrdf_measured_is_isotropic(data->items[k]) ? "yes" : "no",
               hnbrdf_measured_summary(data->items[k]));
}

static void json_data(const cli_data *data)
{
    fputs("{\"kind\": \"data\", \"materials\": [", stdout);
    for (int k = 0; k < data->count; k++) {
        fputs(k ? ", " : "", stdout);
        hnbrdf_write_json_text(stdout, hnbrdf_measured_name(data->items[k]));
    }
    fputs("],\n \"items\": [", stdout);
    for (int k = 0; k < data->count; k++) {
        fputs(k ? ",\n  " : "\n  ", stdout);
        json_measured(data->items[k]);
    }
    fputs("\n]}\n", stdout);
}

/* ---- Command --------------------------------------------------------------------------------- */

static int is_collection(const char *path)
{
    struct stat status;
    return strcmp(path, "builtin") == 0 || (stat(path, &status) == 0 && S_ISDIR(status.st_mode));
}

static int tell_collection(char **argument, int json)
{
    cli_data data = {0};
    if (cli_open_data(argument, 1, &data) != CLI_OK)
        return CLI_FAILURE;
    if (json)
        json_data(&data);
    else
        print_data(&data);
    cli_close_data(&data);
    return CLI_OK;
}

static int tell_source(const char *path, int json)
{
    cli_source source = {0};
    cli_read.merl_identify = 1;
    if (cli_open_source(path, &source) != CLI_OK)
        return CLI_FAILURE;
    if (source.model && json) {
        json_model(source.model);
    } else if (source.model) {
        print_model(path, source.model);
    } else if (json) {
        json_measured(source.measured);
        putchar('\n');
    } else {
        print_measured(path, source.measured);
    }
    cli_close_source(&source);
    return CLI_OK;
}

int cmd_info(int argc, char **argv)
{
    int json = 0, count;
    const cli_option options[] = {
        {"json", 0, CLI_FLAG, &json, 0, 0, NULL, "print JSON (default: a table for people)"},
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 1)
        return cli_usage(&command, "%s",
                         count ? "more than one SOURCE" : "no SOURCE to tell about");
    return is_collection(argv[1]) ? tell_collection(argv + 1, json) : tell_source(argv[1], json);
}
