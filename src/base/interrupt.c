/* interrupt.c: Ctrl-C and SIGTERM as a question to ask while work goes on. */
#include "base/interrupt.h"

#include <signal.h>

static volatile sig_atomic_t interrupted;

static void on_interrupt(int number)
{
    (void)number;
    interrupted = 1;
}

void hnbrdf_catch_interrupts(int on)
{
    signal(SIGINT, on ? on_interrupt : SIG_DFL);
    signal(SIGTERM, on ? on_interrupt : SIG_DFL);
}

int hnbrdf_interrupted(void)
{
    return interrupted != 0;
}
