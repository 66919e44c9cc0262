/* clock.c: seconds that pass, and seconds that processors work. */
#define _POSIX_C_SOURCE 200809L
#include "base/clock.h"

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

double hnbrdf_seconds(void)
{
    LARGE_INTEGER count, a_second;
    QueryPerformanceCounter(&count);
    QueryPerformanceFrequency(&a_second);
    return (double)count.QuadPart / (double)a_second.QuadPart;
}

/* File times count tenths of microseconds. */
static double seconds_of(FILETIME t)
{
    return ((double)t.dwHighDateTime * 4294967296.0 + (double)t.dwLowDateTime) * 1e-7;
}

double hnbrdf_thread_seconds(void)
{
    FILETIME created, ended, kernel, user;
    if (!GetThreadTimes(GetCurrentThread(), &created, &ended, &kernel, &user))
        return 0.0;
    return seconds_of(kernel) + seconds_of(user);
}

double hnbrdf_process_seconds(void)
{
    FILETIME created, ended, kernel, user;
    if (!GetProcessTimes(GetCurrentProcess(), &created, &ended, &kernel, &user))
        return 0.0;
    return seconds_of(kernel) + seconds_of(user);
}
#else
#include <time.h>

static double seconds_of(clockid_t which)
{
    struct timespec t = {0, 0};
    clock_gettime(which, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double hnbrdf_seconds(void)
{
    return seconds_of(CLOCK_MONOTONIC);
}

double hnbrdf_thread_seconds(void)
{
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

double hnbrdf_process_seconds(void)
{
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}
#endif
