// The header that most users include.
#pragma once

#include <gyre/defs.h>
#include <gyre/events.h>
#include <gyre/fields.h>
#include <gyre/fluid.h>
#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/joints.h>
#include <gyre/math.h>
#include <gyre/memory.h>
#include <gyre/queries.h>
#include <gyre/result.h>
#include <gyre/soft.h>
#include <gyre/stepping.h>
#include <gyre/world.h>
