#pragma once
// Where contacts are now, whatever found them: what observers read beside the rows.

namespace talus {

/// Where a contact is now.
struct ContactPlace {
  double gap = 0;   // [m] > 0 apart
  double slip = 0;  // [m] position of the foot along the tangent, in the material of the edge; of a new
                    // contact less the elastic slip by the stress of the ground
  double size = 0;  // of the smaller block [m]
  double closed =
      0;  // overlap less the rise as share of the mean thickness, along the normal, of the thinner block
};

}  // namespace talus
