#include "backend/pose_graph.h"
