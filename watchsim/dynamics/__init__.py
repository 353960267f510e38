"""Forces and impulses at one instant; no time stepping."""
