// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/certificate.h"
