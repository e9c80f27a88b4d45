#include "mapping/occupancy_grid.h"
