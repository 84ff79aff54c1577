"""The Peano-HASEL muscle without a body: the zipping pouch, what its analytic model lacks, and its file."""
