/* Loses memory on purpose, with a device open as in a run: the sanitizers have to say so, or their silence about everything else means nothing. */
#include "device.h"

#include <stdlib.h>
#include <string.h>

static void *volatile held;

__attribute__((noinline)) static void lose_on_purpose(void)
{
    held = malloc(4321);
    memset(held, 1, 4321);
    held = NULL;
}

int main(void)
{
    failure why = {.text = ""};
    device d;
    if (device_open("cpu", false, &d, &why) != STATUS_OK)
        return 2;
    lose_on_purpose();
    device_close(&d);
    return 0;
}
