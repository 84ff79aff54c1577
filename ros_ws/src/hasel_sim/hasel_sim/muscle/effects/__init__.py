"""One effect of the muscle on its bench per file; the catalogue is filled by the files being here."""
