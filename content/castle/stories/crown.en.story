<story>
<p><emotion name="joy" weight="0.4"/>Have you ever seen a crown that was worn for <gesture name="count_one"/>one single day?
<point at="crown"/>There it lies.</p>

<p><look at="visitor"/>Queen Adela was crowned in <gesture name="open_arms"/>this very hall, on the shortest day of winter.
<emotion name="sadness" weight="0.4"/>The goldsmith was to set eight stones, but on the road one of them was <emphasis>stolen</emphasis>.
<emotion name="fear" weight="0.6"/>He was so afraid that he could not sleep.
<prosody volume="soft" rate="92%">At midnight he <hold name="torch"/>took a torch from the wall and <gesture name="hush" weight="0.7"/>crept in here, <look at="paintings"/>past every painted face.</prosody>
The flame <look at="visitor"/>shook in his hand, and all the shadows shook with it.
<prosody volume="soft" rate="92%">So he cut a <gesture name="small" weight="0.8"/>little piece out of the window,</prosody> and set it in the gold.</p>

<p><emotion name="surprise" weight="0.4"/>In the morning, <hold name="nothing"/>the whole court held its breath.
<break time="400ms"/><emotion name="joy" weight="0.7"/>Then the <gesture name="wonder"/>sun came in, and the stones blazed: <break time="150ms"/>red, <break time="150ms"/>and blue, <break time="150ms"/>and green.
<look at="crown"/><prosody rate="85%">And the eighth shone clear as water.</prosody></p>

<p><look at="visitor"/><emotion name="neutral"/>The queen saw it at once, <break time="300ms"/>and she said <gesture name="shake_head" weight="0.5"/>nothing.
<emotion name="fear" weight="0.35"/>She said nothing at dinner, and nothing at the dance, and the goldsmith turned as white as candle wax.
<break time="300ms"/><emotion name="joy" weight="0.3"/>Late that evening she lifted the crown from her head, and gave it to his <gesture name="small" weight="0.8"/>little daughter.</p>

<p><prosody pitch="+6%" rate="90%">“A true stone shines for the one who wears it,”</prosody> she said.
<prosody pitch="+6%" rate="88%">“But this one <gesture name="open_arms"/>shines for <emphasis>everybody</emphasis>.”</prosody></p>

<p><emotion name="joy" weight="0.5"/>She never wore it again, and <gesture name="heart"/>that is why all of us can see it today.
<look at="crown"/>Count the stones, if you like: <look at="visitor"/>only <gesture name="point_up"/>one of them is honest glass.</p>
</story>
