/* timed.h: what an exported scene costs in a GL context. */
#ifndef HNBRDF_GL_TIMED_H
#define HNBRDF_GL_TIMED_H

#include "check/verify.h"
#include "gl/context.h"

/* The fast build of the scene's first material on uniform pairs: the best of a few draws. Text and
 * weights as for gl_verify(). */
hnbrdf_result gl_time_scene(const gl_context *context, const char *text, const void *weights,
                            size_t weights_size, check_timing *timing, hnbrdf_error *error);

#endif
