/* commands.h: the subcommands of `hnbrdf`, in the order of `hnbrdf --help`: name, what it does in
 * one line. Each is a function cmd_NAME in cmd_NAME.c; argv[0] is the subcommand's name. */
#ifndef HNBRDF_CLI_COMMANDS_H
#define HNBRDF_CLI_COMMANDS_H

#define CLI_COMMANDS(ROW)                                                                   \
    ROW(fit, "fit a model to measured materials")                                           \
    ROW(compare, "error of a model against measured materials")                             \
    ROW(info, "what a model or a measured file holds")                                      \
    ROW(eval, "BRDF values for pairs of directions, CSV to CSV")                            \
    ROW(export, "write a model's materials as one GLSL include")                            \
    ROW(verify, "prove on a GPU that the exported shader equals the C library")             \
    ROW(stability, "error against an oracle at extremes, on CPU and GPU")                   \
    ROW(render, "picture of a sphere under an environment map")                             \
    ROW(scene, "picture of a scene with global illumination")                               \
    ROW(sheet, "contact sheet: reference, GGX alone and model, side by side")               \
    ROW(edit, "change a material: colour, refraction, roughness, angle")                    \
    ROW(mix, "materials between two of a model")                                            \
    ROW(lobes, "where samples of a material go: fit, or take the paper's scheme")           \
    ROW(gallery, "pages of edited and mixed materials")                                     \
    ROW(bake, "the smallest network that is good enough for the materials of a scene")      \
    ROW(report, "errors of a grid of networks and baselines, over directions or of images") \
    ROW(bench, "run time beside error, on the CPU and on GPUs")                             \
    ROW(import, "published .brdf shaders to a model file")

#define CLI_DECLARE(name, about) int cmd_##name(int argc, char **argv);
CLI_COMMANDS(CLI_DECLARE)
#undef CLI_DECLARE

#endif
