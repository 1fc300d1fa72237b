/* What `clast bench tune` has found to be fastest on a device, kept between runs beside the compiled programs. */
#ifndef CLAST_HOST_TUNING_H
#define CLAST_HOST_TUNING_H
#include "device.h"

/* What holds where nothing has been measured. */
tuning tuning_default(const device_info *info);
/* From the cache; the defaults where there is nothing, where it makes no sense, or where CLAST_TUNING is set to `off`. */
tuning tuning_load(const device_info *info);
/* Keeps it for this device with this driver; `path` gets the name of the file. */
status tuning_store(const device_info *info, const tuning *of, char *path, size_t size, failure *why);
/* Removes what was kept. */
status tuning_forget(const device_info *info, char *path, size_t size, failure *why);

#endif
