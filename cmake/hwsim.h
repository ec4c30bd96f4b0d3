#pragma once
// The library in one include: labs and their answers, tables, run folders, GPU files, pictures. It is
// installed as <hwsim.h>; every header stands for itself, too (cmake/public_headers.txt).
#include "hwsim/gpu/gpu_config.h"
#include "lab/base/table.h"
#include "lab/environment.h"
#include "lab/lab.h"
#include "lab/results/run_record.h"
#include "pipeline/image/image_io.h"
