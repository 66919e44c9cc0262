/* bake.c: bakes a network for one material of a model with the installed libraries. */
#include <hnbrdf/bake.h>

#include <stdio.h>
#include <string.h>

int main(void)
{
    static const char *const name = "plain";
    hnbrdf_material material;
    hnbrdf_model_desc desc;
    hnbrdf_bake_options options;
    hnbrdf_bake_report report;
    hnbrdf_model *model, *baked;
    hnbrdf_error error;
    int picked;

    hnbrdf_material_init(&material);
    memset(&desc, 0, sizeof desc);
    desc.kind = HNBRDF_KIND_GGX;
    desc.material_count = 1;
    desc.materials = &material;
    desc.names = &name;
    memset(&options, 0, sizeof options);
    options.wish = HNBRDF_BAKE_NET;
    options.hidden = 4;
    options.layers = 1;
    options.steps = 10;
    options.restarts = 1;
    options.pool = 1024;
    options.pairs = 100;
    if (hnbrdf_model_create(&desc, NULL, &model, &error) ||
        hnbrdf_bake(model, &options, &baked, &report, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    picked = report.rows[report.picked].size.hidden;
    hnbrdf_bake_report_free(&report);
    hnbrdf_model_free(baked);
    hnbrdf_model_free(model);
    return picked == 4 ? 0 : 1;
}
