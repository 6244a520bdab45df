One sentence. <gesture name="wave"/>Another.
