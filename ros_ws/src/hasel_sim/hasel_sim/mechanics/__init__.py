"""The body as a solid: state, stresses, element forces and the band matrix; every array in all lanes."""
