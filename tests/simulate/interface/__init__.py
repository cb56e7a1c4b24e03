"""An independent model of contact: at every node of the tip, in the place of patches and strips."""
