"""How a rope is made of wires, and what its section follows from that."""
