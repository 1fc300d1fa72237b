/* The calls that set arguments and enqueue work, in place of the library's: each fails where `fails(name)` says so, and goes on to the library's own else.
 * Whoever includes this has defined `fails` and NEXT. */
cl_int clSetKernelArg(cl_kernel kernel, cl_uint index, size_t size, const void *value)
{
    return fails("clSetKernelArg") ? CL_OUT_OF_RESOURCES : NEXT(clSetKernelArg)(kernel, index, size, value);
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset, const size_t *global,
                              const size_t *local, cl_uint waits, const cl_event *wait, cl_event *event)
{
    return fails("clEnqueueNDRangeKernel")
               ? CL_OUT_OF_RESOURCES
               : NEXT(clEnqueueNDRangeKernel)(queue, kernel, dimensions, offset, global, local, waits, wait, event);
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem mem, cl_bool blocking, size_t offset, size_t size, void *data, cl_uint waits,
                           const cl_event *wait, cl_event *event)
{
    return fails("clEnqueueReadBuffer") ? CL_OUT_OF_RESOURCES
                                        : NEXT(clEnqueueReadBuffer)(queue, mem, blocking, offset, size, data, waits, wait, event);
}

cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem mem, cl_bool blocking, size_t offset, size_t size, const void *data,
                            cl_uint waits, const cl_event *wait, cl_event *event)
{
    return fails("clEnqueueWriteBuffer") ? CL_OUT_OF_RESOURCES
                                         : NEXT(clEnqueueWriteBuffer)(queue, mem, blocking, offset, size, data, waits, wait, event);
}

cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem mem, const void *pattern, size_t pattern_size, size_t offset, size_t size,
                           cl_uint waits, const cl_event *wait, cl_event *event)
{
    return fails("clEnqueueFillBuffer") ? CL_OUT_OF_RESOURCES
                                        : NEXT(clEnqueueFillBuffer)(queue, mem, pattern, pattern_size, offset, size, waits, wait, event);
}

cl_int clEnqueueCopyBuffer(cl_command_queue queue, cl_mem from, cl_mem to, size_t from_offset, size_t to_offset, size_t size, cl_uint waits,
                           const cl_event *wait, cl_event *event)
{
    return fails("clEnqueueCopyBuffer") ? CL_MEM_OBJECT_ALLOCATION_FAILURE
                                        : NEXT(clEnqueueCopyBuffer)(queue, from, to, from_offset, to_offset, size, waits, wait, event);
}

cl_int clFinish(cl_command_queue queue)
{
    return fails("clFinish") ? CL_OUT_OF_RESOURCES : NEXT(clFinish)(queue);
}
