/* report_options.c: lists of networks and models. */
#include "cli/report.h"

#include <stdlib.h>
#include <string.h>

/* ---- Lists ----------------------------------------------------------------------------------- */

int report_read_nets(const cli_command *command, const char *list, report *r)
{
    for (const char *at = list;; at++) {
        if (r->net_count == REPORT_NETS)
            return cli_usage(command, "--nets: more than %d", (int)REPORT_NETS);
        int *net = r->nets[r->net_count];
        at = cli_parse_net(at, net);
        if (!at || (*at != ',' && *at != '\0'))
            return cli_usage(
                command, "--nets: '%s' is not HxN,HxN,... with H from 1 to %d and N from 1 to %d",
                list, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
        for (int k = 0; k < r->net_count; k++)
            if (r->nets[k][0] == net[0] && r->nets[k][1] == net[1])
                return cli_usage(command, "--nets: %dx%d is there twice", net[0], net[1]);
        r->net_count++;
        if (*at == '\0')
            return -1;
    }
}

int report_read_latents(const cli_command *command, const char *list, report *r)
{
    int most = HNBRDF_MAX_LATENT - REPORT_ANALYTIC_NUMBERS;
    for (const char *at = list;; at++) {
        int value = 0, length = 0;
        if (r->latent_count == REPORT_LATENTS)
            return cli_usage(command, "--latents: more than %d", (int)REPORT_LATENTS);
        if (sscanf(at, "%2d%n", &value, &length) != 1 || value < 1 || value > most ||
            (at[length] != ',' && at[length] != '\0'))
            return cli_usage(command, "--latents: '%s' is not a list of whole numbers from 1 to %d",
                             list, most);
        for (int k = 0; k < r->latent_count; k++)
            if (r->latents[k] == value)
                return cli_usage(command, "--latents: %d is there twice", value);
        r->latents[r->latent_count++] = value;
        at += length;
        if (*at == '\0')
            return -1;
    }
}

int report_read_models(const cli_command *command, const char *list, report *r)
{
    r->forms[REPORT_GGX] = 1;
    while (*list) {
        size_t length = strcspn(list, ",");
        report_form form = REPORT_GGX;
        while (report_form_name(form) && (strlen(report_form_name(form)) != length ||
                                          strncmp(list, report_form_name(form), length) != 0))
            form++;
        if (!report_form_name(form))
            return cli_usage(command, "--models: '%.*s', expected hybrid, paper or neural",
                             (int)length, list);
        r->forms[form] = 1;
        list += length + (list[length] == ',');
    }
    return -1;
}

char *report_join(int argc, char **argv)
{
    size_t size = sizeof "hnbrdf";
    for (int k = 0; k < argc; k++)
        size += strlen(argv[k]) + 1;
    char *text = malloc(size);
    if (!text)
        return NULL;
    size_t at = (size_t)snprintf(text, size, "hnbrdf");
    for (int k = 0; k < argc; k++)
        at += (size_t)snprintf(text + at, size - at, " %s", argv[k]);
    return text;
}
