/* interrupt.h: Ctrl-C and SIGTERM as a question to ask while work goes on. For tools only: a
 * library leaves signals to its host. */
#ifndef HNBRDF_BASE_INTERRUPT_H
#define HNBRDF_BASE_INTERRUPT_H

/* on = 1: from here both signals only make hnbrdf_interrupted() say 1. on = 0: they end the process
 * again. Once 1, the answer stays. */
void hnbrdf_catch_interrupts(int on);
int hnbrdf_interrupted(void);

#endif
