/* watch.h: how the long functions of this room tell how far they are and ask whether to stop. */
#ifndef HNBRDF_REPORT_WATCH_H
#define HNBRDF_REPORT_WATCH_H

#include <stddef.h>

/* Zero-initialise; what is NULL is not called. */
typedef struct report_watch {
    /* Called often; share from 0 to 1. */
    void (*show)(void *user, double share, const char *detail);
    /* Not 0: stop soon, what is finished stays. */
    int (*stop)(void *user);
    /* A line for the user: the path of a picture that was written. */
    void (*tell)(void *user, const char *line);
    void *user;
} report_watch;

static inline void report_show(const report_watch *watch, double share, const char *detail)
{
    if (watch->show)
        watch->show(watch->user, share, detail);
}

static inline int report_stop(const report_watch *watch)
{
    return watch->stop && watch->stop(watch->user);
}

static inline void report_tell(const report_watch *watch, const char *line)
{
    if (watch->tell)
        watch->tell(watch->user, line);
}

#endif
