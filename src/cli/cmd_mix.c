/* cmd_mix.c: `hnbrdf mix`: materials between two of a model. */
#include "edit/palette.h"
#include "base/text.h"

#include <math.h>
#include <string.h>

static const cli_command command = {
    "mix",
    "MODEL A B --t 0:1:0.25 [--as PREFIX] [-o OUT]",
    "Adds materials on the way from A (t = 0) to B (t = 1) to a model: albedo, reflectance and "
    "latent "
    "code\n"
    "go linearly, the logarithm of the roughness too, the tangent frame turns the short way.\n"
    "They are named PREFIX-T, as in gold-chrome-0.25. FIRST:LAST:STEP is a sweep, ends included.",
    "hnbrdf mix model.safetensors gold chrome --t 0.5\n"
    "hnbrdf mix model.safetensors gold chrome --t 0:1:0.25 --as polish -o polish.safetensors",
};

enum { MAX_STEPS = 1000 };

typedef struct sweep {
    double first, step;
    int count;
} sweep;

/* "0.5" or "0:1:0.25". Returns -1 to go on, as cli_parse() does. */
static int read_sweep(const char *text, sweep *s)
{
    double values[3] = {0, 0, 0};
    const char *at = text, *end = text + strlen(text);
    int n = 0;
    while (n < 3 && (at = hnbrdf_parse_double(at, end, &values[n])) != NULL) {
        n++;
        if (at == end || *at != ':')
            break;
        at++;
    }
    if (!at || at != end || (n != 1 && n != 3))
        return cli_usage(&command,
                         "--t: '%s' is neither T, as in 0.5, nor FIRST:LAST:STEP, as in 0:1:0.25",
                         text);
    double last = n == 3 ? values[1] : values[0];
    if (values[0] < 0.0 || values[0] > 1.0 || last < 0.0 || last > 1.0)
        return cli_usage(&command, "--t: %s leaves the range from 0 (A) to 1 (B)", text);
    s->first = values[0];
    s->step = values[2];
    s->count = 1;
    if (n == 1)
        return -1;
    double steps = values[2] > 0.0 ? (last - values[0]) / values[2] : -1.0;
    if (!(steps >= 0.0) || steps >= MAX_STEPS)
        return cli_usage(&command,
                         "--t: %s: expected LAST not below FIRST, STEP above 0, at most %d values",
                         text, (int)MAX_STEPS);
    s->count = (int)floor(steps + 1e-9) + 1; /* 0.7/0.1 is a little below 7 */
    return -1;
}

/* The name of the material at t, "A-B-0.25" unless there is a prefix; 0 after a message if too
 * long. */
static int make_name(char *name, size_t size, const char *const ends[2], const char *prefix,
                     double t)
{
    int length = prefix ? snprintf(name, size, "%s-%.6g", prefix, t)
                        : snprintf(name, size, "%s-%s-%.6g", ends[0], ends[1], t);
    if (length > 0 && (size_t)length < size)
        return 1;
    cli_fail("the name of a mixed material is longer than %d bytes, choose a short one with --as",
             HNBRDF_MAX_NAME);
    return 0;
}

static int put_all(palette *p, const sweep *s, const char *const ends[2], const char *prefix,
                   int replace)
{
    int a = cli_choose_material(p->model, ends[0]),
        b = a < 0 ? -1 : cli_choose_material(p->model, ends[1]);
    if (a < 0 || b < 0)
        return CLI_FAILURE;
    for (int k = 0; k < s->count; k++) {
        char name[HNBRDF_MAX_NAME + 1];
        hnbrdf_material mixed;
        double t = fmin(s->first + k * s->step, 1.0);
        hnbrdf_material_mix(hnbrdf_model_material(p->model, a), hnbrdf_model_material(p->model, b),
                            (float)t, &mixed);
        if (!make_name(name, sizeof name, ends, prefix, t) ||
            palette_put(p, name, &mixed, replace) != CLI_OK)
            return CLI_FAILURE;
    }
    return CLI_OK;
}

static int run(const char *path, const char *output, const sweep *s, const char *const ends[2],
               const char *prefix, int replace)
{
    palette p;
    if (palette_open(&p, path) != CLI_OK)
        return CLI_FAILURE;
    int before = p.count, result = put_all(&p, s, ends, prefix, replace);
    if (result == CLI_OK)
        result = palette_save(&p, output);
    if (result == CLI_OK) {
        printf("%s: %d material%s from %s to %s, %d new\n", output, s->count,
               s->count == 1 ? "" : "s", ends[0], ends[1], p.count - before);
        for (int k = before; k < p.count; k++)
            printf("  %s\n", p.names[k]);
    }
    palette_close(&p);
    return result;
}

int cmd_mix(int argc, char **argv)
{
    const char *t = NULL, *as = NULL, *output = NULL;
    int replace = 0, count;
    sweep s;
    const cli_option options[] = {
        {"t", 't', CLI_TEXT, &t, 0, 0, "T",
         "0 is A, 1 is B; FIRST:LAST:STEP for several (required)"},
        {"as", 0, CLI_TEXT, &as, 0, 0, "PREFIX", "what the names begin with (default A-B)"},
        {"replace", 0, CLI_FLAG, &replace, 0, 0, NULL, "overwrite materials of these names"},
        {"output", 'o', CLI_TEXT, &output, 0, 0, "OUT",
         "the model file to write (default: MODEL, rewritten)"},
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 3)
        return cli_usage(
            &command, "found %d arguments, expected MODEL and the names of two materials", count);
    if (!t)
        return cli_usage(&command, "no --t T");
    result = read_sweep(t, &s);
    if (result >= 0)
        return result;
    const char *const ends[2] = {argv[2], argv[3]};
    return run(argv[1], output ? output : argv[1], &s, ends, as, replace);
}
