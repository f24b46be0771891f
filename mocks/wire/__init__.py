"""The instruments' bytes: written from the protocol table, in ignorance of who reads them."""
