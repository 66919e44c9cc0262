/* clock.h: seconds that pass, and seconds that processors work. */
#ifndef HNBRDF_BASE_CLOCK_H
#define HNBRDF_BASE_CLOCK_H

/* Since some moment; never set back. */
double hnbrdf_seconds(void);
/* Processor seconds of the calling thread, and of the whole process: what they worked, whatever
 * else the machine did. */
double hnbrdf_thread_seconds(void);
double hnbrdf_process_seconds(void);

#endif
